// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/interchange/model_to_mat.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/registry/build.hpp"
#include "experiments/interchange/mat_file.hpp"
#include "mat_labels.hpp"
#include "write_files.hpp"

namespace cordon::mat {

namespace {

bool equal(const Matrix& A, const Matrix& B) {
  return A.rows() == B.rows() && A.cols() == B.cols() && A == B;
}

bool equal(const LineForm& X, const LineForm& Y) {
  return X.c.size() == Y.c.size() && X.c == Y.c && equal(X.M, Y.M) && equal(X.G, Y.G) &&
         equal(X.S, Y.S) && equal(X.A, Y.A) && X.b.size() == Y.b.size();
}

/// x + y, if that is a double.
std::optional<double> exact_sum(double x, double y) {
  const double sum = x + y, rest = sum - x;
  if (!std::isfinite(sum) || !std::isfinite(rest)) return std::nullopt;
  const double error = (x - (sum - rest)) + (y - rest);
  return error == 0 ? std::optional(sum) : std::nullopt;
}

/// The simplest type that holds the blocks as they are.
const char* type_of(const LineForm& X) {
  if (X.lines() > 0) return "line_zonotope";
  if (X.constraints() > 0) return "constrained_zonotope";
  return X.generators() > 0 ? "zonotope" : "point";
}

/// The matrices of a model, empty where there are none: all modes have the same fields.
Struct matrices(const Model& model) {
  const LinearModel& m = model.linear;
  const bool intervals = m.A_radius.size() > 0 || m.B_radius.size() > 0 || m.C_radius.size() > 0;
  Struct system;
  system.set("type", text(m.is_descriptor() ? "descriptor" : intervals ? "interval_lti" : "lti"));
  system.set("E", matrix(m.E)).set("A", matrix(m.A)).set("B", matrix(m.B)).set("Bw", matrix(m.Bw));
  system.set("C", matrix(m.C)).set("D", matrix(m.D)).set("Dv", matrix(m.Dv));
  system.set("A_radius", matrix(m.A_radius))
      .set("B_radius", matrix(m.B_radius))
      .set("C_radius", matrix(m.C_radius));
  system.set("X0", to_mat(model.X0)).set("W", to_mat(model.W)).set("V", to_mat(model.V));
  return system;
}

/// Rows [low high]; empty where all are exactly 1.
Matrix ranges(const Box& box) {
  Matrix rows(box.dim(), box.dim() > 0 ? 2 : 0);
  if (box.dim() > 0) rows << box.lower, box.upper;
  return rows;
}

/// Columns that are collected one by one.
class Columns {
 public:
  explicit Columns(std::int64_t& budget) : budget_(budget) {}
  void add(const Vector& column) {
    budget_ -= column.size();
    if (budget_ < 0) {
      throw Error(Errc::invalid,
                  "the data hold more than " + std::to_string(max_numbers) +
                      " numbers: leave them out with --no-data, or take fewer steps");
    }
    rows_ = column.size(), ++count_;
    numbers_.insert(numbers_.end(), column.begin(), column.end());
  }
  bool any() const { return count_ > 0; }
  Value value() const { return matrix(Eigen::Map<const Matrix>(numbers_.data(), rows_, count_)); }

 private:
  std::int64_t& budget_;
  std::vector<double> numbers_;
  Index rows_ = 0, count_ = 0;
};

}  // namespace

std::optional<Box> as_box(const LineForm& X) {
  Box box{X.c, X.c};
  for (Index i = 0; i < X.dim(); ++i) {
    const bool line = X.M.row(i).any(), generator = X.G.row(i).any();
    if (line) box.lower[i] = -infinity, box.upper[i] = infinity;
    if (!generator || line) continue;
    const double radius = X.G.row(i).cwiseAbs().maxCoeff();
    const auto lower = exact_sum(X.c[i], -radius), upper = exact_sum(X.c[i], radius);
    if (!lower || !upper) return std::nullopt;
    box.lower[i] = *lower, box.upper[i] = *upper;
  }
  return equal(make_box(box), X) ? std::optional(box) : std::nullopt;
}

Value to_mat(const LineForm& X) { return to_mat(X, {}); }

Value to_mat(const LineForm& X, const Inequalities& rows) {
  const std::optional<Box> box = as_box(X);
  const bool whole = box && X.dim() > 0 && X.lines() == X.dim();
  Struct set;
  const bool bounds = box && !whole && X.generators() + X.lines() > 0;
  set.set("type", text(whole ? "space" : bounds ? "box" : type_of(X)));
  set.set("c", matrix(X.c)).set("G", matrix(X.G)).set("A", matrix(X.A)).set("b", matrix(X.b));
  set.set("M", matrix(X.M)).set("S", matrix(X.S));
  if (bounds) set.set("lower", matrix(box->lower)).set("upper", matrix(box->upper));
  if (rows.rows() > 0) set.set("H", matrix(rows.H)).set("h", matrix(rows.h));
  return std::move(set).value();
}

Value to_mat(const ModeBank& bank, const Labels& labels) {
  const Mode& nominal = bank[bank.nominal];
  if (!nominal.model.is_linear())
    throw Error(Errc::unsupported, "a system by formulas has no form in MAT-files");
  const auto has_region = [](const Mode& mode) { return mode.model.region.has_value(); };
  if (std::ranges::any_of(bank.modes, has_region)) {
    throw Error(
        Errc::unsupported,
        "a system with a \"region\" has no form in MAT-files, where it would hold everywhere");
  }
  Struct system = matrices(nominal.model);
  system.set("F", matrix(nominal.model.linear.F))
      .set("U", to_mat(nominal.model.U))
      .set("nominal", text(nominal.name));
  std::vector<Struct> modes;
  for (Index j = 0; j < bank.size(); ++j) {
    if (j == bank.nominal) continue;
    Struct mode = matrices(bank[j].model);
    mode.set("name", text(bank[j].name));
    mode.set("actuator", matrix(ranges(bank[j].model.linear.actuator)));
    mode.set("sensor", matrix(ranges(bank[j].model.linear.sensor)));
    modes.push_back(std::move(mode));
  }
  if (!modes.empty()) system.set("modes", Struct::array(std::move(modes)));
  add_labels(system, labels);
  return std::move(system).value();
}

Value to_mat(DataSource& data) {
  std::int64_t budget = max_numbers;
  Columns k(budget), u(budget), y(budget), x(budget), n(budget), mode(budget);
  while (const std::optional<Record> record = data.next()) {
    k.add(Vector::Constant(1, static_cast<double>(record->sample.k)));
    u.add(record->sample.u);
    y.add(record->sample.y);
    if (record->truth) x.add(*record->truth);
    if (record->fault) n.add(*record->fault);
    if (record->mode) mode.add(Vector::Constant(1, static_cast<double>(*record->mode)));
  }
  Struct all;
  all.set("k", k.value()).set("u", u.value()).set("y", y.value());
  if (x.any()) all.set("x", x.value());
  if (n.any()) all.set("n", n.value());
  if (mode.any()) all.set("mode", mode.value());
  return std::move(all).value();
}

Value about(const std::string& what, const std::string& title) {
  Struct fields;
  fields.set("format", number(1))
      .set("holds", text(what))
      .set("title", text(title))
      .set("version", text(build_info().version));
  return std::move(fields).value();
}

}  // namespace cordon::mat

namespace cordon {

void study_to_mat(const Study& study, const Target& target, bool with_data) {
  mat::Variables all{{"cordon", mat::about("study", study.title)},
                     {"system", mat::to_mat(bank_of(study), study.labels)}};
  const auto* simulate = std::get_if<SimulateSpec>(&study.data);
  if (with_data && !(simulate && simulate->steps == 0))
    all.push_back({"data", mat::to_mat(*open_data(study))});
  detail::write_files({{target.file, mat::to_bytes(all)}}, target.replace);
}

}  // namespace cordon
