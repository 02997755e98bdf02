// SPDX-License-Identifier: GPL-3.0-or-later
// The order of states, disturbances and outputs, the unit of all states and the origin of time are
// conventions: estimates do not depend on them. Time itself is not: k is that of each formula.
#include <algorithm>
#include <random>
#include <regex>

#include <doctest/doctest.h>

#include "input_design/plugins.hpp"
#include "nonlinear/methods.hpp"
#include "nonlinear/reference.hpp"
#include "nonlinear/trajectory.hpp"

using namespace cordon;
using namespace cordon::test;
using estimators::NonlinearRecursion;

namespace {

/// Inputs and outputs of a run; the first sample is that of time `first`.
struct Samples {
  std::vector<Vector> u, y;
  Index first = 0;
};

Samples samples_of(const Json& example, std::size_t count) {
  Samples made;
  for (std::size_t k = 0; k < count; ++k) {
    made.u.push_back(vector_of(example["u"][k]));
    made.y.push_back(vector_of(example["y"][k]));
  }
  return made;
}

std::vector<Box> boxes_of(const Model& model, const Method& method, const Samples& samples) {
  const auto backend = examples::backend(method.backend);
  NonlinearRecursion recursion(model, backend, method.options);
  std::vector<Box> boxes;
  recursion.start(backend->import(model.X0));
  for (std::size_t i = 0; i < samples.y.size(); ++i) {
    const Index k = samples.first + static_cast<Index>(i);
    if (i > 0) REQUIRE(recursion.predict(samples.u[i - 1], k - 1));
    REQUIRE(recursion.correct({k, samples.u[i], samples.y[i]}));
    boxes.push_back(recursion.box());
  }
  return boxes;
}

/// Of their own size; the second ones in the reversed order of coordinates where that is said.
void check_same(const std::vector<Box>& boxes, const std::vector<Box>& others, double scale,
                bool is_reversed) {
  REQUIRE(boxes.size() == others.size());
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    CAPTURE(k);
    const Index n = boxes[k].dim();
    for (Index i = 0; i < n; ++i) {
      const Index j = is_reversed ? n - 1 - i : i;
      const double size =
          1e-9 * (1 + std::max(std::abs(boxes[k].lower[i]), std::abs(boxes[k].upper[i])));
      CHECK(std::abs(others[k].lower[j] / scale - boxes[k].lower[i]) <= size);
      CHECK(std::abs(others[k].upper[j] / scale - boxes[k].upper[i]) <= size);
    }
  }
}

void reverse(Json& list) { std::ranges::reverse(list.get_ref<Json::array_t&>()); }

/// The same system with its states and disturbances in reversed order.
Json with_reversed_states(Json system) {
  for (const char* list : {"states", "f", "disturbances"}) reverse(system[list]);
  for (const char* set : {"X0", "W"})
    for (const char* rows : {"center", "generators"}) reverse(system[set][rows]);
  return system;
}

/// The same system with its outputs and noises in reversed order.
Json with_reversed_outputs(Json system) {
  for (const char* list : {"g", "noises"}) reverse(system[list]);
  for (const char* rows : {"center", "generators"}) reverse(system["V"][rows]);
  return system;
}

/// The system in states that are `scale` times as large.
Json enlarged(Json system, const std::string& scale) {
  const std::vector<std::string> names = system["states"];
  const auto replaced = [&](std::string formula) {
    for (const std::string& name : names)
      formula = std::regex_replace(formula, std::regex("\\b" + name + "\\b"),
                                   "(" + name + "/" + scale + ")");
    return formula;
  };
  for (Json& row : system["f"]) row = scale + "*(" + replaced(row) + ")";
  for (const char* rows : {"g", "invariants"}) {
    if (!system.contains(rows)) continue;
    for (Json& row : system[rows]) row = replaced(row);
  }
  for (Json& entry : system["X0"]["center"]) entry = std::stod(scale) * entry.get<double>();
  for (Json& row : system["X0"]["generators"])
    for (Json& entry : row) entry = std::stod(scale) * entry.get<double>();
  return system;
}

}  // namespace

TEST_CASE("states and disturbances in another order have the same boxes in that order") {
  const Json all = reference();
  for (const Json& example : all["examples"]) {
    const Model model = model_of(example["system"]),
                other = model_of(with_reversed_states(example["system"]));
    const Samples samples = samples_of(example, 6);
    for (const Method& method : methods()) {
      CAPTURE(example["name"].get<std::string>());
      CAPTURE(std::string(method.reference));
      check_same(boxes_of(model, method, samples), boxes_of(other, method, samples), 1, true);
    }
  }
}

TEST_CASE("outputs in another order have the same boxes where no row comes first") {
  const Json all = reference();
  for (const Json& example : all["examples"]) {
    if (example["system"]["g"].size() < 2) continue;
    const Model model = model_of(example["system"]),
                other = model_of(with_reversed_outputs(example["system"]));
    const Samples samples = samples_of(example, 6);
    Samples reversed = samples;
    for (Vector& y : reversed.y) y = y.reverse().eval();
    int compared = 0;
    for (const Method& method : methods()) {
      // Strips are cut one after the other, contraction takes row by row.
      if (method.options.row_by_row || method.options.contracts) continue;
      CAPTURE(std::string(method.reference));
      check_same(boxes_of(model, method, samples), boxes_of(other, method, reversed), 1, false);
      ++compared;
    }
    CHECK(compared > 0);
  }
}

TEST_CASE("one unit for all states is a convention of strips too") {
  const Json all = reference();
  for (const Json& example : all["examples"]) {
    const Model model = model_of(example["system"]),
                other = model_of(enlarged(example["system"], "1024"));
    const Samples samples = samples_of(example, 6);
    for (const Method& method : methods()) {
      CAPTURE(example["name"].get<std::string>());
      CAPTURE(std::string(method.reference));
      check_same(boxes_of(model, method, samples), boxes_of(other, method, samples), 1024, false);
    }
  }
}

namespace {

/// A plant whose formulas change with time, counted from `origin`.
Json changing(const std::string& origin) {
  const std::string k = "(k - " + origin + ")";
  Json system = {{"states", {"a", "b"}}, {"inputs", {"u"}}};
  system["disturbances"] = {"w"};
  system["noises"] = {"v"};
  system["f"] = {"0.8*a + " + k + "*b/10 + u + 3*" + k, "0.5*b + 0.1*sin(a + " + k + ") + w"};
  system["g"] = {"a*(2 + " + k + "/5) + 7*" + k + " + b^2 + v"};
  system["X0"] = {{"center", {1, 0.5}}, {"generators", {{0.5, 0}, {0, 0.25}}}};
  system["W"] = {{"center", {0}}, {"generators", {{0.01}}}};
  system["V"] = {{"center", {0.01}}, {"generators", {{0.02}}}};
  return system;
}

/// Of one trajectory of the plant counted from 0, every input another one.
Samples changing_samples(const Model& model, std::vector<Vector>& states) {
  Samples samples;
  Trajectory trajectory(model, 5);
  for (Index k = 0; k < 8; ++k) {
    samples.u.push_back(Vector::Constant(1, 5.0 * static_cast<double>(k % 3)));
    samples.y.push_back(trajectory.output(samples.u.back(), k));
    states.push_back(trajectory.x());
    trajectory.advance(samples.u.back(), k);
  }
  return samples;
}

}  // namespace

TEST_CASE("formulas of time: each has the k and the input of its own step") {
  const Model model = model_of(changing("0"));
  std::vector<Vector> states;
  const Samples samples = changing_samples(model, states);
  for (const Method& method : methods()) {
    CAPTURE(std::string(method.reference));
    const std::vector<Box> boxes = boxes_of(model, method, samples);
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      CAPTURE(k);
      CHECK(boxes[k].contains(states[k]));
      // Narrower than what a step of time or of the input changes.
      CHECK(2 * boxes[k].radius()[0] < 2.5);
    }
  }
}

TEST_CASE("another origin of time has the same boxes") {
  const Model model = model_of(changing("0")), later = model_of(changing("1000"));
  std::vector<Vector> states;
  const Samples samples = changing_samples(model, states);
  Samples moved = samples;
  moved.first = 1000;
  for (const Method& method : methods()) {
    CAPTURE(std::string(method.reference));
    check_same(boxes_of(model, method, samples), boxes_of(later, method, moved), 1, false);
  }
}
