// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>

#include "cordon/core/interval.hpp"
#include "read_continuous.hpp"
#include "study/reading/read_sets.hpp"
#include "study/text/numbers.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;
constexpr std::size_t max_modes = 1000, max_formula_modes = 50;
constexpr std::size_t max_copied = 50'000'000;  // numbers in all copies of the nominal model

std::size_t entries(const LineForm& X) {
  return static_cast<std::size_t>(X.M.size() + X.G.size() + X.c.size() + X.S.size() + X.A.size() +
                                  X.b.size());
}

std::size_t entries(const Model& model) {
  const LinearModel& linear = model.linear;
  const Index matrices = linear.E.size() + linear.A.size() + linear.B.size() + linear.Bw.size() +
                         linear.C.size() + linear.D.size() + linear.Dv.size() +
                         linear.A_radius.size() + linear.B_radius.size() + linear.C_radius.size() +
                         linear.F.size();
  return static_cast<std::size_t>(matrices) + entries(model.X0) + entries(model.W) +
         entries(model.V) + entries(model.U);
}

/// One entry: exact, or a range.
bool read_entry(const Cursor& at, double& low, double& high) {
  const std::string form =
      "write a number, or a range [low, high], between 0 (outage) and 1 (health)";
  if (at.is(Kind::array)) {
    const auto range = read_vector(at);
    if (!range) return false;
    if (range->size() != 2) {
      at.error("has " + counted(range->size(), "number") + ", a range has 2", form);
      return false;
    }
    low = (*range)[0], high = (*range)[1];
  } else {
    if (!at.expect(Kind::number, form)) return false;
    low = high = at.value().number;
  }
  for (const double x : {low, high}) {
    if (x >= 0 && x <= 1) continue;
    at.error("holds " + detail::to_text(x) + ", effectiveness lies in [0, 1]", form);
    return false;
  }
  if (low <= high) return true;
  at.error("the range is empty: " + detail::to_text(low) + " is above " + detail::to_text(high),
           "exchange the two");
  return false;
}

std::optional<Matrix> read_additive_matrix(const Cursor& additive, const char* key,
                                           std::optional<Index> rows, const char* like) {
  const auto at = additive.find(key);
  auto F = at ? read_matrix(*at) : std::nullopt;
  if (F && rows && F->rows() != *rows) {
    at->error("is " + shape(F->rows(), F->cols()) + ", must have " + counted(*rows, "row") +
              " like " + like);
    return std::nullopt;
  }
  return F;
}

std::optional<Additive> read_additive(const Cursor& at, const SystemPart& nominal,
                                      std::vector<std::string>& warnings) {
  const std::string form =
      "{\"F\": [[1], [0]], \"f\": {\"type\": \"box\", \"lower\": [-1], \"upper\": [1]}}";
  if (!at.expect_keys({"F", "Fy", "f"}, "key of an additive fault", form)) return std::nullopt;
  const std::size_t before = at.problems().met();
  Additive additive;
  additive.F = read_additive_matrix(at, "F", nominal.sizes.states, "/system/A");
  additive.Fy = read_additive_matrix(at, "Fy", nominal.sizes.outputs, "/system/C");
  if (!at.find("F") && !at.find("Fy"))
    at.error("holds neither \"F\" nor \"Fy\"",
             "F acts on the states, Fy on the outputs; give one of the two, or both");
  const auto f_at = at.need("f",
                            "the set of the fault's values, for example {\"type\": \"box\", "
                            "\"lower\": [-1], \"upper\": [1]}");
  auto f = f_at ? read_set(*f_at, warnings) : std::nullopt;
  if (!f || at.problems().met() != before) return std::nullopt;
  for (const char* key : {"F", "Fy"}) {
    const std::optional<Matrix>& F = key == std::string("F") ? additive.F : additive.Fy;
    if (!F || F->cols() == f->dim()) continue;
    at.find(key)->error("is " + shape(F->rows(), F->cols()) + ", must have " +
                        counted(f->dim(), "column") + " like " + f_at->pointer());
  }
  additive.f = std::move(*f);
  return at.problems().met() == before ? std::optional<Additive>(std::move(additive))
                                       : std::nullopt;
}

std::optional<LineForm> read_mode_set(const Cursor& mode, const char* key, Index dim,
                                      const char* like, std::vector<std::string>& warnings) {
  const auto at = mode.find(key);
  auto X = at ? read_set(*at, warnings) : std::nullopt;
  if (!X || X->dim() == dim) return X;
  at->error("has dimension " + std::to_string(X->dim()) + ", must have " + std::to_string(dim) +
            " like the columns of " + like);
  return std::nullopt;
}

Matrix beside(const Matrix& A, const Matrix& B) {
  Matrix both(A.rows(), A.cols() + B.cols());
  both << A, B;
  return both;
}

/// Names of modes that are taken, with the places of their first use.
class Names {
 public:
  void take(const Cursor& at, const std::string& name) {
    const auto [first, fresh] = seen_.emplace(name, at.pointer());
    if (!fresh)
      at.error("repeats the name " + in_quotes(name) + " of " + first->second,
               "names of modes are unique");
  }
  void take_default(const std::string& name) {
    seen_.emplace(name, "the nominal mode (/system/nominal)");
  }

 private:
  std::map<std::string, std::string> seen_;
};

/// {u : f u ∈ side for all f ∈ [low, high]}, rounded inward; low ≤ high are in [0, 1].
Interval inputs_under(Interval side, double low, double high) {
  Interval found = real_line;
  for (const double f : {low, high}) {
    if (f == 0 && side.contains(0)) continue;
    if (f == 0) return {1, -1};
    const auto bound = [&](double end) {
      return std::isinf(end) ? Interval{end, end} : directed::over(end, f);
    };
    found = intersection(found, {bound(side.lower).upper, bound(side.upper).lower});
  }
  return found;
}

/// The inputs of which what the actuators make lies in the box.
Box inputs_under(Box inputs, const Box& actuator) {
  for (Index i = 0; i < inputs.dim(); ++i) {
    const Interval side =
        inputs_under({inputs.lower[i], inputs.upper[i]}, actuator.lower[i], actuator.upper[i]);
    inputs.lower[i] = side.lower;
    inputs.upper[i] = side.upper;
  }
  return inputs;
}

}  // namespace

Model model_of(const WrittenMode& mode, const Model& nominal) {
  Model model = mode.system ? *mode.system : nominal;
  model.U = nominal.U;
  model.linear.F = nominal.linear.F;
  if (mode.W) model.W = *mode.W;
  if (mode.V) model.V = *mode.V;
  if (mode.additive && mode.additive->F) {
    model.linear.Bw = beside(model.linear.Bw, *mode.additive->F);
    model.W = cartesian_product(model.W, mode.additive->f);
  }
  if (mode.additive && mode.additive->Fy) {
    model.linear.Dv = beside(model.linear.Dv, *mode.additive->Fy);
    model.V = cartesian_product(model.V, mode.additive->f);
  }
  if (model.nonlinear) return model;
  if (mode.actuator) model.linear.actuator = *mode.actuator;
  if (mode.actuator && model.region)
    model.region->inputs = inputs_under(model.region->inputs, *mode.actuator);
  if (mode.sensor) model.linear.sensor = *mode.sensor;
  model.linear = with_exact_effectiveness_applied(std::move(model.linear));
  return model;
}

const std::vector<std::string>& mode_keys() {
  static const std::vector<std::string> keys{"actuator", "sensor", "additive", "W", "V", "system"};
  return keys;
}

std::optional<Box> read_effectiveness(const Cursor& at, Index size, const std::string& like) {
  if (!at.expect(Kind::array, "a list with a number or a range [low, high] for each of " + like))
    return std::nullopt;
  if (static_cast<Index>(at.size()) != size) {
    at.error("has " + std::to_string(at.size()) + (at.size() == 1 ? " entry" : " entries") +
             ", must have " + std::to_string(size) + " like " + like);
    return std::nullopt;
  }
  Box box{Vector(size), Vector(size)};
  bool good = true;
  for (Index i = 0; i < size; ++i)
    good = read_entry(at.item(static_cast<std::size_t>(i)), box.lower[i], box.upper[i]) && good;
  return good ? std::optional<Box>(std::move(box)) : std::nullopt;
}

bool expect_moderate(const Cursor& list, const Model& nominal, std::size_t limit,
                     const std::string& noun) {
  if (list.size() > limit) {
    list.error("holds more than " + std::to_string(limit) + " " + noun);
    return false;
  }
  if (list.size() * entries(nominal) <= max_copied) return true;
  list.error("is too long for a system of this size: its models would hold more than " +
                 std::to_string(max_copied) + " numbers",
             "give fewer " + noun);
  return false;
}

std::optional<WrittenMode> read_mode(const Cursor& at, const SystemPart& nominal,
                                     std::vector<std::string>& warnings) {
  const std::size_t before = at.problems().met();
  WrittenMode mode;
  if (const auto system = at.find("system")) {
    for (const char* key : {"additive", "W", "V"}) {
      if (const auto other = at.find(key))
        other->error("cannot stand beside \"system\"", "make it part of that system");
    }
    mode.system = read_mode_system(*system, nominal, warnings).model;
  }
  const LinearModel& linear = nominal.model.linear;
  if (const auto actuator = at.find("actuator"))
    mode.actuator = read_effectiveness(*actuator, linear.inputs(), "the columns of /system/B");
  if (const auto sensor = at.find("sensor"))
    mode.sensor = read_effectiveness(*sensor, linear.outputs(), "the rows of /system/C");
  if (at.problems().met() != before) return std::nullopt;
  const auto& continuous = nominal.continuous;
  const Index disturbances = continuous ? continuous->Bw.cols() : linear.disturbances();
  mode.W = read_mode_set(at, "W", disturbances, "/system/Bw", warnings);
  if (mode.W && continuous && !continuous->sampling->keeps_matrices() && disturbances > 0)
    mode.W = sample(*at.find("W"), *continuous, continuous->Bw, *mode.W);
  mode.V = read_mode_set(at, "V", linear.noises(), "/system/Dv", warnings);
  if (const auto additive = at.find("additive"))
    mode.additive = read_additive(*additive, nominal, warnings);
  if (mode.additive && continuous) sample(*at.find("additive"), *continuous, *mode.additive);
  return at.problems().met() == before ? std::optional<WrittenMode>(std::move(mode)) : std::nullopt;
}

void read_modes(const Cursor& system, SystemPart& part, std::vector<std::string>& warnings) {
  const std::size_t before = system.problems().met();
  Names names;
  if (const auto at = system.find("nominal")) {
    part.nominal = read_line(*at, max_name).value_or(part.nominal);
    names.take(*at, part.nominal);
  } else {
    names.take_default(part.nominal);
  }
  const auto list = system.find("modes");
  const std::string form = part.formulas
                               ? "a list of modes: [{\"name\": ..., \"parameters\": {...}}]"
                               : "a list of modes: [{\"name\": ..., \"actuator\": [...]}]";
  if (list && list->expect(Kind::array, form) &&
      expect_moderate(*list, part.model, part.formulas ? max_formula_modes : max_modes, "modes")) {
    for (std::size_t i = 0; i < list->size(); ++i) {
      const Cursor at = list->item(i);
      std::vector<std::string> keys = part.formulas ? formula_mode_keys() : mode_keys();
      keys.insert(keys.begin(), "name");
      if (!at.expect_keys(keys, "key of a mode",
                          part.formulas ? "{\"name\": ..., \"parameters\": {...}}"
                                        : "{\"name\": ..., \"actuator\": [...]}"))
        continue;
      const auto name_at = at.need("name", "every mode has a name of its own");
      const auto name = name_at ? read_line(*name_at, max_name) : std::nullopt;
      if (name) names.take(*name_at, *name);
      if (!part.good) continue;
      auto mode =
          part.formulas ? read_formula_mode(at, system, part) : read_mode(at, part, warnings);
      if (!name || !mode) continue;
      mode->name = *name;
      part.modes.push_back({*name, model_of(*mode, part.model)});
      part.written.push_back(std::move(*mode));
    }
  }
  part.modes_good = part.good && system.problems().met() == before;
}

}  // namespace cordon::json
