// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/interfaces/descriptor_matrix.hpp"
#include "read_continuous.hpp"
#include "read_nonlinear.hpp"
#include "study/reading/read_parts.hpp"
#include "study/reading/read_sets.hpp"

namespace cordon::json {

namespace {

/// Reads the matrices of a model one after another and compares their shapes with those read
/// before. A matrix that is wrong leaves the sizes it would have fixed unknown, and what depends on
/// them unchecked.
class SystemReader {
 public:
  /// `nominal`: the system is that of a mode.
  SystemReader(const Cursor& system, const SystemPart* nominal, std::vector<std::string>& warnings)
      : system_(system), nominal_(nominal), warnings_(warnings), before_(system.problems().met()) {}

  SystemPart read();

 private:
  std::optional<Matrix> matrix(const char* key);
  std::optional<Matrix> interval_matrix(const char* key, Matrix& radius);
  bool has_rows(const char* key, const std::optional<Matrix>& A, std::optional<Index> rows,
                const char* like);
  bool has_cols(const char* key, const std::optional<Matrix>& A, std::optional<Index> cols,
                const char* like);
  void read_dynamics(bool descriptor);
  void read_descriptor_matrix();
  void warn_of_rank(const Matrix& E);
  void read_outputs();
  void read_faults();
  void read_sets(std::optional<Index> disturbances, std::optional<Index> noises);
  void read_bounds_set(const char* key, std::optional<Index> dim, const std::string& like,
                       LineForm& out);
  void read_validity();
  void compare_with_nominal();
  void compare(const char* key, std::optional<Index> size, std::optional<Index> wanted,
               const char* noun);
  std::string place(const char* key) const { return child(system_.pointer(), key); }

  const Cursor& system_;
  const SystemPart* nominal_;
  std::vector<std::string>& warnings_;
  std::size_t before_;
  bool exact_ = false;  ///< interval matrices are refused
  SystemPart part_;
  std::optional<Index> disturbances_, noises_;
};

std::optional<Matrix> SystemReader::matrix(const char* key) {
  const auto at = system_.find(key);
  if (!at) return std::nullopt;
  const bool by_interval = at->is(Value::Kind::object) && !is_sparse_matrix(at->value());
  if (by_interval && !at->expect(Value::Kind::array, "only A, B and C can be known by an interval"))
    return std::nullopt;
  return read_matrix(*at);
}

/// The centre; the radius of an exact matrix stays as it is.
std::optional<Matrix> SystemReader::interval_matrix(const char* key, Matrix& radius) {
  const auto at = system_.find(key);
  if (!at) return std::nullopt;
  if (exact_ && at->is(Value::Kind::object) && !is_sparse_matrix(at->value())) {
    at->error("is an interval matrix, in a system of type \"lti\"",
              "write \"type\": \"interval_lti\"");
    return std::nullopt;
  }
  auto read = read_interval_matrix(*at);
  if (!read) return std::nullopt;
  radius = std::move(read->radius);
  return std::move(read->center);
}

bool SystemReader::has_rows(const char* key, const std::optional<Matrix>& A,
                            std::optional<Index> rows, const char* like) {
  if (!A || !rows || A->rows() == *rows) return A.has_value();
  system_.find(key)->error("is " + shape(A->rows(), A->cols()) + ", must have " +
                           counted(*rows, "row") + " like " + place(like));
  return false;
}

bool SystemReader::has_cols(const char* key, const std::optional<Matrix>& A,
                            std::optional<Index> cols, const char* like) {
  if (!A || !cols || A->cols() == *cols) return A.has_value();
  system_.find(key)->error("is " + shape(A->rows(), A->cols()) + ", must have " +
                           counted(*cols, "column") + " like " + place(like));
  return false;
}

void SystemReader::read_dynamics(bool descriptor) {
  LinearModel& model = part_.model.linear;
  std::optional<Index>& n = part_.sizes.states;
  system_.need("A", "the matrix of x⁺ = A x + B u + Bw w, n × n");
  if (const auto A = interval_matrix("A", model.A_radius)) {
    if (A->rows() != A->cols() || A->rows() == 0 || A->rows() > max_dimension) {
      system_.find("A")->error(
          "is " + shape(A->rows(), A->cols()) +
          (A->rows() == A->cols() ? ", must have 1 to 1000 rows" : ", must be square"));
    } else {
      n = A->rows();
      model.A = *A;
    }
  }
  if (descriptor) read_descriptor_matrix();
  if (system_.find("B")) {
    const auto B = interval_matrix("B", model.B_radius);
    if (has_rows("B", B, n, "A")) part_.sizes.inputs = B->cols(), model.B = *B;
  } else {
    part_.sizes.inputs = 0;
    model.B = Matrix(n.value_or(0), 0);
  }
  if (system_.find("Bw")) {
    const auto Bw = matrix("Bw");
    if (has_rows("Bw", Bw, n, "A")) disturbances_ = Bw->cols(), model.Bw = *Bw;
  } else if (n) {
    disturbances_ = n;
    model.Bw = Matrix::Identity(*n, *n);
  }
}

void SystemReader::read_descriptor_matrix() {
  system_.need("E",
               "the matrix of E x⁺ = A x + B u + Bw w, n × n; without one the type is \"lti\"");
  const auto E = matrix("E");
  if (!E) return;
  if (E->rows() != E->cols()) {
    system_.find("E")->error("is " + shape(E->rows(), E->cols()) + ", must be square");
  } else if (has_rows("E", E, part_.sizes.states, "A")) {
    part_.model.linear.E = *E;
    warn_of_rank(*E);
  }
}

/// Tells of an E whose rank depends on how its numbers are read.
void SystemReader::warn_of_rank(const Matrix& E) {
  const Index used = descriptor_rank(E);
  if (used == E.rows()) return;
  const Index doubles = rank_of_doubles(E), decimals = rank_of_decimals(E);
  if (doubles == used && decimals == used) return;
  const Cursor at = *system_.find("E");
  warnings_.push_back(
      at.pointer() + " (line " + std::to_string(at.value().line) + "): has rank " +
      std::to_string(decimals) + " as it is written in decimals, " + std::to_string(doubles) +
      " as doubles, and " + std::to_string(used) + " up to rounding errors; rank " +
      std::to_string(used) +
      " is used throughout: a singular value below 1e-10 of the largest counts as zero");
}

void SystemReader::read_outputs() {
  LinearModel& model = part_.model.linear;
  const Sizes& sizes = part_.sizes;
  std::optional<Index>& p = part_.sizes.outputs;
  system_.need("C", "the matrix of y = C x + D u + Dv v");
  const auto C = interval_matrix("C", model.C_radius);
  if (C && (C->rows() == 0 || C->rows() > max_dimension)) {
    system_.find("C")->error("is " + shape(C->rows(), C->cols()) + ", must have 1 to 1000 rows",
                             "an observer needs at least one output");
  } else if (C) {
    p = C->rows();
    if (has_cols("C", C, sizes.states, "A")) model.C = *C;
  }
  if (system_.find("D")) {
    const auto D = matrix("D");
    const bool rows = has_rows("D", D, p, "C"), cols = has_cols("D", D, sizes.inputs, "B");
    if (rows && cols) model.D = *D;
  } else if (p && sizes.inputs) {
    model.D = Matrix::Zero(*p, *sizes.inputs);
  }
  if (system_.find("Dv")) {
    const auto Dv = matrix("Dv");
    if (has_rows("Dv", Dv, p, "C")) noises_ = Dv->cols(), model.Dv = *Dv;
  } else if (p) {
    noises_ = p;
    model.Dv = Matrix::Identity(*p, *p);
  }
}

/// The directions of additive faults.
void SystemReader::read_faults() {
  const auto at = system_.find("F");
  if (at && nominal_) {
    at->error("belongs to /system: additive faults have the same directions in all modes",
              "remove it here");
    return;
  }
  if (!at) {
    part_.sizes.faults = 0;
    return;
  }
  const auto F = matrix("F");
  if (!has_rows("F", F, part_.sizes.states, "A")) return;
  if (F->cols() > max_dimension) {
    at->error("is " + shape(F->rows(), F->cols()) + ", must have at most " +
              std::to_string(max_dimension) + " columns");
    return;
  }
  part_.sizes.faults = F->cols();
  if (F->cols() > 0) part_.model.linear.F = *F;
}

void SystemReader::read_bounds_set(const char* key, std::optional<Index> dim,
                                   const std::string& like, LineForm& out) {
  if (!system_.find(key) && dim == Index{0}) {
    out = make_point(Vector(0));
    return;
  }
  const auto at = system_.need(key,
                               "the set of all values it can take, for example {\"type\": \"box\", "
                               "\"lower\": [...], \"upper\": [...]}");
  auto X = at ? read_set(*at, warnings_) : std::nullopt;
  if (!X) return;
  if (dim && X->dim() != *dim) {
    at->error("has dimension " + std::to_string(X->dim()) + ", must have " + std::to_string(*dim) +
              " like " + like);
    return;
  }
  out = std::move(*X);
}

void SystemReader::read_sets(std::optional<Index> disturbances, std::optional<Index> noises) {
  const Sizes& sizes = part_.sizes;
  if (system_.find("X0")) {
    read_bounds_set("X0", sizes.states, "the rows of " + place("A"), part_.model.X0);
  } else if (nominal_) {
    part_.model.X0 = nominal_->model.X0;
  } else if (sizes.states) {
    part_.model.X0 = make_space(*sizes.states);
  }
  const std::string w_like = system_.find("Bw")
                                 ? "the columns of " + place("Bw")
                                 : "the rows of " + place("A") + " (Bw is the identity by default)";
  const std::string v_like = system_.find("Dv")
                                 ? "the columns of " + place("Dv")
                                 : "the rows of " + place("C") + " (Dv is the identity by default)";
  if (system_.find("U") && !nominal_) {
    read_bounds_set("U", sizes.inputs, "the columns of " + place("B"), part_.model.U);
  } else if (sizes.inputs) {
    part_.model.U = make_space(*sizes.inputs);
  }
  read_bounds_set("W", disturbances, w_like, part_.model.W);
  read_bounds_set("V", noises, v_like, part_.model.V);
}

void SystemReader::read_validity() {
  const auto at = system_.find("region");
  if (!at) {
    if (nominal_) part_.model.region = nominal_->model.region;
    return;
  }
  if (!exact_ || system_.find("continuous")) {
    at->error("is for systems of type \"lti\" that are written from k to k + 1",
              "write it there, as \"cordon linearise\" does, or remove it");
    return;
  }
  part_.model.region = read_region(*at, part_.sizes.states, part_.sizes.inputs);
}

void SystemReader::compare(const char* key, std::optional<Index> size, std::optional<Index> wanted,
                           const char* noun) {
  if (!size || !wanted || size == wanted) return;
  const auto at = system_.find(key);
  (at ? *at : system_)
      .error("has " + counted(*size, noun) + ", /system has " + std::to_string(*wanted),
             "all modes have the same numbers of states, inputs and outputs");
}

void SystemReader::compare_with_nominal() {
  compare("A", part_.sizes.states, nominal_->sizes.states, "state");
  compare("B", part_.sizes.inputs, nominal_->sizes.inputs, "input");
  compare("C", part_.sizes.outputs, nominal_->sizes.outputs, "output");
}

SystemPart SystemReader::read() {
  if (!system_.expect(Value::Kind::object, "{\"type\": \"lti\", \"A\": [[...]], ...}")) return {};
  const auto type_at = system_.need("type", "\"lti\", \"interval_lti\", or \"descriptor\" with E");
  const auto type = type_at ? read_choice(*type_at, system_types()) : std::nullopt;
  std::vector<std::string> keys{"type", "E", "A",  "B", "Bw", "C",     "D",
                                "Dv",   "F", "X0", "W", "V",  "region"};
  if (!nominal_)
    keys.insert(keys.end(),
                {"U", "nominal", "modes", "names", "sampling_time", "continuous", "disturbance"});
  exact_ = type == "lti";
  if (type && type != "descriptor") {
    if (const auto E = system_.find("E"))
      E->error("belongs to descriptor systems", "write \"type\": \"descriptor\", or remove E");
  }
  system_.expect_keys(keys, nominal_ ? "key of a mode's system" : "key of a system", "");
  read_dynamics(type == "descriptor");
  read_outputs();
  read_faults();
  read_sets(disturbances_, noises_);
  read_validity();
  if (nominal_) compare_with_nominal();
  part_.continuous = nominal_ ? nominal_->continuous : read_continuous(system_);
  if (!nominal_) {
    const Sizes& sizes = part_.sizes;
    part_.labels = read_labels(
        system_, {sizes.states, sizes.inputs, sizes.outputs, disturbances_, noises_, sizes.faults});
  }
  if (system_.problems().met() == before_ && part_.continuous) {
    const auto matrices =
        type == "lti" ? sampling::Matrices::doubles : sampling::Matrices::enclosed;
    part_.continuous = sample(system_, *part_.continuous, matrices, part_.model, warnings_);
    if (part_.continuous && !part_.continuous->sampling->keeps_matrices())
      part_.labels.disturbances.clear();
  }
  part_.good = system_.problems().met() == before_;
  if (!nominal_) read_modes(system_, part_, warnings_);
  return std::move(part_);
}

}  // namespace

bool is_nonlinear(const Cursor& system) {
  if (!system.is(Value::Kind::object)) return false;
  const auto type = system.find("type");
  return type && type->is(Value::Kind::text) && type->value().text() == "nonlinear";
}

const std::vector<std::string>& system_types() {
  static const std::vector<std::string> names{"lti", "interval_lti", "descriptor", "nonlinear"};
  return names;
}

SystemPart read_system(const Cursor& system, const ComponentContext& context) {
  if (is_nonlinear(system)) {
    return read_nonlinear(system, context.warnings,
                          [&](const Cursor& plant) { return read_plant_system(plant, context); });
  }
  return SystemReader(system, nullptr, context.warnings).read();
}

SystemPart read_recorded_system(const Cursor& system, std::vector<std::string>& warnings,
                                const Cursor* results) {
  if (is_nonlinear(system)) {
    return read_nonlinear(system, warnings, [&](const Cursor&) {
      return results ? read_recorded_plant(*results) : std::nullopt;
    });
  }
  return SystemReader(system, nullptr, warnings).read();
}

SystemPart read_mode_system(const Cursor& system, const SystemPart& nominal,
                            std::vector<std::string>& warnings) {
  if (is_nonlinear(system)) {
    system.find("type")->error("modes are linear systems", "use the type of /system");
    return {};
  }
  return SystemReader(system, &nominal, warnings).read();
}

}  // namespace cordon::json
