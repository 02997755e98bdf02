// SPDX-License-Identifier: GPL-3.0-or-later
// Inputs for modes by formulas.
#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include "cordon/study/design.hpp"
#include "run/scratch.hpp"

using namespace cordon;

namespace {

PipelineDesign designed(const std::string& system, const std::string& designer) {
  const Scratch scratch;
  Registry registry;
  registry.load({{CORDON_BINARY_DIR "/lib/cordon/plugins-v1"}});
  const Study study = read_study(
      scratch.write("s.json", R"({"cordon": 1, "system": )" + system +
                                  R"(, "pipelines": [{"backend": "zonotope", "designer": )" +
                                  designer + "}]}"),
      registry, {}, StudyPlugins::refuse, StudyData::optional);
  std::vector<PipelineDesign> designs = design_study(study, registry, {});
  REQUIRE(designs.size() == 1);
  return std::move(designs[0]);
}

double cost_of(const PipelineDesign& design) {
  CHECK(design.error == "");
  REQUIRE(design.outcome);
  INFO(design.outcome->reason);
  REQUIRE(design.outcome->best);
  CHECK(design.outcome->best->separates() == Answer::yes);
  REQUIRE(design.exact);
  CHECK(design.exact->separates() == Answer::yes);
  CHECK(design.refuted.empty());
  return design.outcome->best->cost;
}

/// x⁺ = x + a u², y = x + v with a = 1 or 0.5: two outputs differ by a u² + v_1 - v_0, so that the
/// modes are apart if and only if 0.5 u_0² > 4 · 0.1.
const char* const square = R"json({"type": "nonlinear", "states": ["x"], "inputs": ["u"],
  "noises": ["v"], "parameters": {"a": 1}, "f": ["x + a*u^2"], "g": ["x + v"],
  "X0": {"type": "box", "lower": [-1], "upper": [1]},
  "V": {"type": "box", "lower": [-0.1], "upper": [0.1]},
  "U": {"type": "box", "lower": [-2], "upper": [2]},
  "modes": [{"name": "half", "parameters": {"a": 0.5}}]})json";

}  // namespace

TEST_CASE("the least input of formulas that are known in closed form is found") {
  for (const char* designer : {"facets", "milp"}) {
    const PipelineDesign design = designed(
        square, R"({"type": ")" + std::string(designer) + R"(", "horizon": 1, "epsilon": 1e-4})");
    const double least = std::sqrt(0.8);
    const double cost = cost_of(design);
    CHECK(cost >= least);
    CHECK(cost <= least * (1 + 2e-3));
    CHECK(design.outcome->status == DesignStatus::feasible);
  }
}

TEST_CASE("formulas that are linear cost what the linear system does") {
  const auto system = [](const std::string& dynamics) {
    return "{" + dynamics + R"json(, "X0": {"type": "box", "lower": [-0.2], "upper": [0.2]},
      "W": {"type": "box", "lower": [-0.1], "upper": [0.1]},
      "V": {"type": "box", "lower": [-0.1], "upper": [0.1]},
      "U": {"type": "box", "lower": [-5], "upper": [5]},)json";
  };
  const std::string formulas = system(R"json("type": "nonlinear", "states": ["x"], "inputs": ["u"],
      "disturbances": ["w"], "noises": ["v"], "parameters": {"b": 1},
      "f": ["0.5*x + b*u + w"], "g": ["x + v"])json") +
                               R"("modes": [{"name": "weak", "parameters": {"b": 0.5}}]})";
  const std::string linear = system(R"json("type": "lti", "A": [[0.5]], "B": [[1]], "Bw": [[1]],
      "C": [[1]], "Dv": [[1]])json") +
                             R"("modes": [{"name": "weak", "actuator": [0.5]}]})";
  const std::string designer = R"({"type": "facets", "horizon": 3, "cost": "norm_1"})";
  const double a = cost_of(designed(linear, designer)), b = cost_of(designed(formulas, designer));
  CHECK(b >= a * (1 - 1e-8));
  CHECK(b <= a * (1 + 1e-3));
}

TEST_CASE("a given input of formulas is judged, and tubes that meet prove nothing") {
  const auto judged = [](double u) {
    return designed(square, R"({"type": "given", "input": [[)" + std::to_string(u) + "], [0]]}");
  };
  cost_of(judged(0.895));
  const PipelineDesign meets = judged(0.893);
  REQUIRE(meets.outcome->best);
  CHECK(meets.outcome->best->pairs[0].disjoint == Answer::unknown);
  CHECK(meets.exact->pairs[0].disjoint == Answer::unknown);
  CHECK(meets.outcome->best->separates() == Answer::unknown);
  CHECK(meets.outcome->reason.find("not decided") != std::string::npos);
}

TEST_CASE("formulas that end are told with mode and time") {
  const PipelineDesign design = designed(R"json({"type": "nonlinear", "states": ["x"],
    "inputs": ["u"], "parameters": {"a": 1}, "f": ["x - a*sqrt(x) + u"], "g": ["x"],
    "X0": {"type": "box", "lower": [0.9], "upper": [1.1]},
    "modes": [{"name": "fast", "parameters": {"a": 1.5}}]})json",
                                         R"({"type": "given", "input": [[0], [0], [0]]})");
  CHECK(design.error.find("healthy") != std::string::npos);
  CHECK(design.error.find("k = 1") != std::string::npos);
  CHECK(design.error_code == Errc::not_enclosed);
}

TEST_CASE("a level that may not be known from below is refused with the set") {
  CHECK_THROWS_WITH_AS(designed(R"json({"type": "nonlinear", "states": ["x"], "inputs": ["u"],
      "parameters": {"a": 1}, "f": ["a*x + u"], "g": ["x"], "X0": {"type": "space", "dim": 1},
      "U": {"type": "box", "lower": [-1], "upper": [1]},
      "modes": [{"name": "slow", "parameters": {"a": 0.5}}]})json",
                                R"({"type": "facets", "horizon": 2})"),
                       doctest::Contains("is not bounded, and states are followed"), InputError);
}
