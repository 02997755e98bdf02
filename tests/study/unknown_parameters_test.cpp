// SPDX-License-Identifier: GPL-3.0-or-later
// Parameters of formulas of which bounds are known.
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "study/study_run.hpp"

using Json = nlohmann::ordered_json;
using Run = test::StudyRun;

namespace {

/// A tank with a leak, once as a parameter with bounds, once as a state that is written down.
Json tank() {
  return Json::parse(R"json({"cordon": 1, "title": "tank",
    "system": {"type": "nonlinear", "states": ["level"], "inputs": ["pump"],
      "disturbances": ["w"], "noises": ["v"],
      "parameters": {"a": 0.3, "leak": {"lower": 0, "upper": 0.05}},
      "f": ["level + 0.5*pump - (a + leak)*sqrt(level) + w"],
      "g": ["level + v"],
      "X0": {"type": "box", "lower": [3.5], "upper": [4.5]},
      "W": {"type": "box", "lower": [-0.01], "upper": [0.01]},
      "V": {"type": "box", "lower": [-0.05], "upper": [0.05]}},
    "data": {"simulate": {"steps": 40, "seed": 7, "x0": [4.2, 0.012],
      "input": [{"type": "sine", "offset": 1.2, "amplitude": 0.2, "omega": 0.5}]}},
    "pipelines": [{"backend": "interval", "observer": "nonlinear"},
                  {"backend": "zonotope", "observer": "nonlinear"},
                  {"backend": "constrained_zonotope", "observer": "nonlinear"}],
    "metrics": ["radius", "contains_truth"]})json");
}

Json tank_by_states() {
  Json study = tank();
  Json& system = study["system"];
  system["states"] = {"level", "leak"};
  system["parameters"] = {{"a", 0.3}};
  system["f"].push_back("leak");
  system["X0"] = Json::parse(R"({"type": "box", "lower": [3.5, 0], "upper": [4.5, 0.05]})");
  return study;
}

}  // namespace

TEST_CASE("a constant parameter with bounds is a state that keeps its value") {
  const Run run(tank()), by_states(tank_by_states());
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  REQUIRE(by_states.outcome.code == 0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Json pipeline = run.pipeline(i);
    CHECK(pipeline["summary"]["outside_from"].is_null());
    CHECK(pipeline["steps"] == by_states.pipeline(i)["steps"]);
  }
  const Json hull = run.pipeline(2)["steps"][40]["hull"];
  CHECK(hull["lower"][1].get<double>() <= 0.012);
  CHECK(hull["upper"][1].get<double>() >= 0.012);
  CHECK(hull["upper"][1].get<double>() - hull["lower"][1].get<double>() < 0.04);
  CHECK(run.text("out/data.csv").find("x_2 leak") != std::string::npos);
  CHECK(run("verify out").code == 0);
}

TEST_CASE("a parameter that varies is a disturbance of f and a noise of g") {
  Json study = tank();
  study["system"]["parameters"]["leak"]["varying"] = true;
  study["system"]["parameters"]["gain"] = {{"lower", 0.99}, {"upper", 1.01}, {"varying", true}};
  study["system"]["g"] = {"gain*level + v"};
  study["data"]["simulate"]["x0"] = {4.2};
  const Run run(study);
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  const Json names = run.results()["study"]["system"]["names"];
  CHECK(names["states"] == Json({"level"}));
  CHECK(names["disturbances"] == Json({"w", "leak"}));
  CHECK(names["noises"] == Json({"v", "gain"}));
  for (std::size_t i = 0; i < 3; ++i) CHECK(run.pipeline(i)["summary"]["outside_from"].is_null());
}

TEST_CASE("studies with bounds of parameters say the same once they are resolved") {
  Json study = tank();
  study["system"]["parameters"]["pipe"] = {{"lower", 0.9}, {"upper", 1.1}, {"varying", true}};
  study["system"]["f"] = {"level + 0.5*pump - (a*pipe + leak)*sqrt(level) + w"};
  study["system"]["admissible"] = Json::parse(R"({"type": "box", "lower": [0], "upper": [9]})");
  study["system"].erase("disturbances");
  study["system"]["f"] = {"level + 0.5*pump - (a*pipe + leak)*sqrt(level)"};
  study["system"].erase("W");
  const Run run(study);
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  const Run again(run.results()["study"]);
  CAPTURE(again.outcome.out);
  REQUIRE(again.outcome.code == 0);
  for (std::size_t i = 0; i < 3; ++i) CHECK(run.pipeline(i)["steps"] == again.pipeline(i)["steps"]);
}

TEST_CASE("mistakes in bounds of parameters are told") {
  Json study = tank();
  study["system"]["parameters"]["leak"] = {{"lower", 0.05}, {"upper", 0.01}, {"vary", true}};
  study["system"]["parameters"]["a"] = {{"lower", 0.1}};
  study["system"]["parameters"]["w"] = {{"lower", 1}, {"upper", 2}};
  study["data"]["simulate"]["x0"] = {4.2};
  const Run run(study);
  CHECK(run.outcome.code == 2);
  for (const char* what :
       {"/system/parameters/leak/upper", "is 0.01, below the lower bound 0.05",
        "unknown key of a parameter", "/system/parameters/a/upper", "repeats the name \"w\"",
        "has 1 number, must have 4 like /system/states, and after them the constant parameters"}) {
    CAPTURE(std::string(what));
    CHECK(run.outcome.out.find(what) != std::string::npos);
  }
}
