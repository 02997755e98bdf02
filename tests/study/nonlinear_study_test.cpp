// SPDX-License-Identifier: GPL-3.0-or-later
// Studies of systems by formulas: what is wrong is reported at its place, all at once; what is
// right runs, is verified as far as it is said, and its resolved form says the same.
#include <sstream>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "study/study_run.hpp"

using Json = nlohmann::ordered_json;
using Run = test::StudyRun;

namespace {

Json pendulum() {
  return Json::parse(R"json({"cordon": 1, "title": "pendulum",
    "system": {"type": "nonlinear", "states": ["angle", "rate"], "inputs": ["torque"],
      "disturbances": ["push"], "noises": ["v"], "parameters": {"dt": 0.05, "g": 9.81},
      "f": ["angle + dt*rate", "rate + dt*(-g*sin(angle) - 0.2*rate + torque + push)"],
      "g": ["angle + v"],
      "X0": {"type": "box", "lower": [-0.5, -1], "upper": [0.5, 1]},
      "W": {"type": "box", "lower": [-0.1], "upper": [0.1]},
      "V": {"type": "box", "lower": [-0.02], "upper": [0.02]}},
    "data": {"simulate": {"steps": 40, "seed": 7, "x0": [0.4, 0.3],
      "input": [{"type": "sine", "amplitude": 0.5, "omega": 0.1}]}},
    "pipelines": [{"backend": "interval", "observer": "nonlinear"},
                  {"backend": "zonotope", "observer": "nonlinear"},
                  {"backend": "constrained_zonotope", "observer": "nonlinear"}],
    "metrics": ["radius", "contains_truth"]})json");
}

void expect_told(const Run& run, const std::string& what) {
  CAPTURE(run.outcome.out);
  CHECK(run.outcome.out.find(what) != std::string::npos);
}

}  // namespace

TEST_CASE("a pendulum by formulas: the truth stays inside, and verification finds nothing") {
  for (const char* rounding : {"nominal", "outward"}) {
    Json study = pendulum();
    for (Json& pipeline : study["pipelines"]) {
      pipeline["name"] = pipeline["backend"];
      pipeline["backend"] = {{"type", pipeline["backend"]}, {"rounding", rounding}};
    }
    const Run run(study);
    CAPTURE(run.outcome.out);
    REQUIRE(run.outcome.code == 0);
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(run.pipeline(i)["summary"]["outside_from"].is_null());
      CHECK(run.pipeline(i)["steps"].size() == 41);
    }
    const test::Outcome verified = run("verify out");
    CAPTURE(verified.out);
    CHECK(verified.code == 0);
    CHECK(verified.out.find("successors by formulas are drawn") != std::string::npos);
  }
}

TEST_CASE("states that explain outputs of little noise are found by aiming at them") {
  Json study = pendulum();
  study["system"]["V"] = Json::parse(R"({"type": "box", "lower": [-1e-6], "upper": [1e-6]})");
  const Run run(study);
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  const test::Outcome verified = run("verify out");
  CAPTURE(verified.out);
  CHECK(verified.code == 0);
}

TEST_CASE("observers by strips: the truth stays inside, and verification finds nothing") {
  Json study = pendulum();
  study["pipelines"] = Json::array();
  for (const char* variant : {"frad_a", "frad_b", "frad_c", "vol_min_a", "vol_min_b"}) {
    study["pipelines"].push_back(
        {{"name", variant},
         {"backend", "zonotope"},
         {"observer", {{"type", "nonlinear_strips"}, {"variant", variant}}}});
  }
  study["data"]["simulate"]["dropouts"] = {{{"probability", 0.2}}};
  const Run run(study);
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(run.pipeline(i)["summary"]["outside_from"].is_null());
    CHECK(run.pipeline(i)["summary"]["inconsistent_from"].is_null());
  }
  // Sets that are predictions need not hold all successors: those of frad_c are passed over.
  const test::Outcome verified = run("verify out");
  CHECK_MESSAGE(verified.code == 5, verified.out);
  CHECK_MESSAGE(verified.says("error: 40 checks could not be decided; all others hold"),
                verified.out);

  study["pipelines"][0]["backend"] = {{"type", "zonotope"}, {"rounding", "outward"}};
  expect_told(Run(study), "computes in doubles");
  study["pipelines"][0]["backend"] = "zonotope";
  study["system"]["W"] = Json::parse(
      R"({"type": "constrained_zonotope", "center": [0], "generators": [[0.1, 0.1]],
          "A": [[1, -1]], "b": [0.5]})");
  study["pipelines"][1]["backend"] = "constrained_zonotope";
  expect_told(Run(study), "W is no zonotope, and this observer knows no others");
}

TEST_CASE("a hull that was altered is refuted by its proof") {
  const Run run(pendulum());
  REQUIRE(run.outcome.code == 0);
  const double lower = run.pipeline(1)["steps"][3]["hull"]["lower"][0].get<double>();
  const std::string before = Json(lower).dump(), after = Json(lower + 0.01).dump();
  run.exchange(before, after);
  CHECK(run("verify out").code == 4);
}

TEST_CASE("a set that misses states which fit the outputs is refuted by draws") {
  const Run run(pendulum());
  REQUIRE(run.outcome.code == 0);
  // Another output at k = 20, by more than V: what fits it lies outside of what was recorded.
  std::istringstream lines(run.text("out/data.csv"));
  std::string line;
  while (std::getline(lines, line) && line.rfind("20,", 0) != 0) continue;
  REQUIRE(line.rfind("20,", 0) == 0);
  const std::size_t second = line.find(',', 3), third = line.find(',', second + 1);
  const double y = std::stod(line.substr(second + 1, third - second - 1));
  const std::string changed =
      line.substr(0, second + 1) + std::to_string(y + 0.03) + line.substr(third);
  run.exchange(line, changed, "out/data.csv");
  const test::Outcome verified = run("verify out");
  CAPTURE(verified.out);
  CHECK(verified.code == 4);
  CHECK(verified.out.find("k = 20") != std::string::npos);
  CHECK(verified.out.find("is consistent with model and data") != std::string::npos);
}

TEST_CASE("without noise and with outward rounding draws refute nothing") {
  Json study = pendulum();
  study["system"]["X0"] = Json::parse(R"({"type": "point", "center": [0.4, 0.3]})");
  for (const char* key : {"W", "V"})
    study["system"][key] = Json::parse(R"({"type": "point", "center": [0]})");
  study["data"]["simulate"]["noise"] = "zero";
  for (Json& pipeline : study["pipelines"]) {
    pipeline["name"] = pipeline["backend"];
    pipeline["backend"] = {{"type", pipeline["backend"]}, {"rounding", "outward"}};
  }
  const Run run(study);
  CAPTURE(run.outcome.out);
  CHECK(run.outcome.code == 0);
  CHECK(run("verify out").code == 5);
}

TEST_CASE("with invariants nothing is drawn, which is said") {
  Json study = pendulum();
  study["system"]["invariants"] = {"0*angle"};
  const Run run(study);
  REQUIRE(run.outcome.code == 0);
  const test::Outcome verified = run("verify out");
  CHECK(verified.code == 5);
  CHECK(verified.out.find("no state that is drawn meets the invariants") != std::string::npos);
}

TEST_CASE("gaps and outliers of formulas") {
  Json study = pendulum();
  study["data"]["simulate"]["dropouts"] = Json::parse(R"([{"probability": 0.3}])");
  study["data"]["simulate"]["outliers"] =
      Json::parse(R"([{"outputs": [1], "from": 5, "probability": 0.2, "shift": 2}])");
  for (Json& pipeline : study["pipelines"]) pipeline["outliers"] = {{"most", 41}, {"in", 41}};
  const Run run(study);
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(run.pipeline(i)["summary"]["outside_from"].is_null());
    CHECK(run.pipeline(i)["summary"]["outliers"]["samples"].get<int>() > 0);
  }
}

TEST_CASE("mistakes in formulas are all told, with their columns") {
  Json study = pendulum();
  Json& system = study["system"];
  system["f"] = {"angle + dt*rte", "rate + sinn(angle) + v"};
  system["g"] = {"angle + push", "sqrt(angle"};
  system["invariants"] = {"angle - k"};
  system["states"] = {"angle", "rate", "sin"};
  system["parameters"]["dt"] = "x";
  system["A"] = Json::parse("[[1]]");
  system["domain"] = "guessed";
  study["data"]["simulate"]["plant"] = "stirred_tank";
  const Run run(study);
  CHECK(run.outcome.code == 2);
  for (const char* what :
       {"/system/f (line", "has 2 formulas, must have 3, one per state", "/system/f/0",
        "column 12: nothing is called rte; did you mean \"rate\"?",
        "column 8: there is no function sinn; did you mean \"sin\"?",
        "column 22: a noise cannot stand in f", "column 9: a disturbance cannot stand in g",
        "the \"(\" of column 5 is not closed", "the time cannot stand in invariants",
        "\"sin\" is no name for a state", "/system/parameters/dt", "/system/A (line",
        "unknown choice \"guessed\"", "/data/simulate/plant"})
    expect_told(run, what);
}

TEST_CASE("who takes linear models only refuses formulas, and the other way round") {
  Json study = pendulum();
  study["pipelines"] = Json::parse(R"([
    {"name": "a", "backend": "zonotope", "observer": "prediction_correction"},
    {"name": "b", "backend": "zonotope", "designer": {"type": "milp", "horizon": 3}}])");
  const Run formulas(study);
  CHECK(formulas.outcome.code == 2);
  expect_told(formulas,
              "\"prediction_correction\" takes linear models, not formulas; use \"nonlinear\"");
  expect_told(formulas, "there are no modes to tell apart");
  study["system"] = Json::parse(R"({"type": "lti", "A": [[0.5]], "C": [[1]],
    "X0": {"type": "box", "lower": [-1], "upper": [1]},
    "W": {"type": "box", "lower": [-1], "upper": [1]},
    "V": {"type": "box", "lower": [-1], "upper": [1]}})");
  study["data"]["simulate"] = {{"steps", 3}};
  study["pipelines"] = Json::parse(R"([{"backend": "zonotope", "observer": "nonlinear"}])");
  const Run linear(study);
  CHECK(linear.outcome.code == 2);
  expect_told(linear, "takes systems of type \"nonlinear\", and this one is linear");
}

TEST_CASE("where no set can be enclosed the pipeline ends with place and reason") {
  Json study = pendulum();
  study["system"]["f"][1] = "rate + dt*sqrt(angle - 0.3999) + push";
  const Run run(study);
  CHECK(run.outcome.code == 2);
  expect_told(run, "no bounded set encloses x_2 at k = 1: sqrt(angle - 0.3999) is not defined");
}

TEST_CASE("where no set can be enclosed an observer may begin anew from the admissible set") {
  Json study = pendulum();
  study["system"]["f"][1] = "rate + dt*(-g*sin(angle) - 0.2*rate + sqrt(angle + 0.6) + push)";
  study["data"]["simulate"]["dropouts"] = {{{"from", 3}, {"to", 25}}};
  const Run stopped(study);
  CHECK(stopped.outcome.code == 2);
  expect_told(stopped, "sqrt(angle + 0.6) is not defined for every");
  study["system"]["admissible"] = {{"type", "box"}, {"lower", {-1, -5}}, {"upper", {1, 5}}};
  for (Json& pipeline : study["pipelines"]) pipeline["on_not_enclosed"] = "restart";
  const Run run(study);
  CAPTURE(run.outcome.out);
  CHECK(run.outcome.code == 0);
  expect_told(run, "anew from the admissible set, at k = ");
  for (std::size_t i = 0; i < 3; ++i) {
    const Json summary = run.pipeline(i)["summary"];
    CHECK(summary["steps"] == 41);
    CHECK(summary["inconsistent_from"].is_null());
    CHECK(summary["failed_assumption"].is_null());
    CHECK(summary.contains("not_enclosed") == (i == 0));
  }
  CHECK(run.pipeline()["summary"]["not_enclosed"]["times"] > 1);
  CHECK(run.pipeline()["summary"]["not_enclosed"]["from"] == 13);
  const test::Outcome verified = run("verify out");
  CAPTURE(verified.out);
  CHECK(verified.code == 0);

  study["system"]["admissible"]["lower"][1] = "-inf";
  study["system"]["admissible"]["upper"][1] = "inf";
  expect_told(Run(study), "needs a bounded set that holds the state at all times");
  study["system"].erase("admissible");
  expect_told(Run(study), "needs a bounded set that holds the state at all times");
}

TEST_CASE("states may be assumed to lie where formulas are defined") {
  Json study = Json::parse(R"json({"cordon": 1, "title": "a level near zero",
    "system": {"type": "nonlinear", "states": ["level"], "inputs": ["pump"],
      "disturbances": ["w"], "noises": ["v"],
      "f": ["level + 0.1*(pump - sqrt(level)) + w"], "g": ["level + v"],
      "X0": {"type": "box", "lower": [0], "upper": [0.4]},
      "W": {"type": "box", "lower": [-0.001], "upper": [0.001]},
      "V": {"type": "box", "lower": [-0.5], "upper": [0.5]}},
    "data": {"simulate": {"steps": 50, "x0": [0.1],
                          "input": [{"type": "constant", "offset": 0.2}]}},
    "metrics": ["radius", "contains_truth"]})json");
  for (const char* backend : {"interval", "zonotope", "constrained_zonotope"}) {
    for (const char* method : {"interval", "mean_value", "first_order", "dc", "relaxation"}) {
      const bool has_cuts = std::string(backend) == "constrained_zonotope";
      if (std::string(method) == "relaxation" && !has_cuts) continue;
      study["pipelines"].push_back({{"name", std::string(backend) + " " + method},
                                    {"backend", backend},
                                    {"observer", {{"type", "nonlinear"}, {"method", method}}}});
    }
  }
  study["pipelines"].push_back(
      {{"name", "strips"}, {"backend", "zonotope"}, {"observer", "nonlinear_strips"}});
  const Run refused(study);
  CHECK(refused.outcome.code == 2);
  expect_told(refused, "sqrt(level) is not defined for every level in [-");
  study["system"]["domain"] = "assumed";
  const Run strips(study);  // whose centre need not be where the formulas are defined
  expect_told(strips, "pipeline \"strips\" stopped after");
  study["pipelines"].erase(study["pipelines"].size() - 1);
  const Run assumed(study);
  CAPTURE(assumed.outcome.out);
  REQUIRE(assumed.outcome.code == 0);
  for (std::size_t i = 0; i < study["pipelines"].size(); ++i) {
    const Json summary = assumed.pipeline(i)["summary"];
    CHECK(summary["contains_truth_yes"] == 51);
    CHECK(summary["inconsistent_from"].is_null());
  }
}

TEST_CASE("an admissible set is assumed, and so is an invariant") {
  Json study = pendulum();
  study["system"]["admissible"] = {{"type", "box"}, {"lower", {0, -5}}, {"upper", {0.6, 5}}};
  study["data"]["simulate"]["steps"] = 6;
  const Run inside(study);
  CHECK(inside.outcome.code == 0);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(inside.pipeline(i)["steps"][0]["hull"]["lower"][0].get<double>() >= -1e-12);
    CHECK(inside.pipeline(i)["summary"]["failed_assumption"].is_null());
  }
  study["data"]["simulate"]["steps"] = 60;  // it swings through zero
  const Run outside(study);
  CHECK(outside.outcome.code == 0);
  CHECK(outside.pipeline()["summary"]["failed_assumption"]["what"] == "admissible_set");
  study["system"].erase("admissible");
  study["system"]["invariants"] = {"angle^2 + rate^2 - 1"};
  const Run invariant(study);
  CHECK(invariant.outcome.code == 0);
  CHECK(invariant.pipeline()["summary"]["failed_assumption"]["what"] == "invariants");
  CHECK(invariant.pipeline()["summary"]["failed_assumption"]["k"] == 0);
}

TEST_CASE("an admissible set may leave states open, and states may stay on its boundary") {
  Json study = pendulum();
  study["system"]["f"] = {"0.3*angle + 0.07 + 0*push", "0.3*rate + 0.7*angle + 0*torque"};
  study["system"]["admissible"] = {
      {"type", "box"}, {"lower", {0.1, "-inf"}}, {"upper", {1, "inf"}}};
  study["system"]["X0"] = Json::parse(R"({"type": "point", "center": [0.1, 0.1]})");
  study["data"]["simulate"]["x0"] = {0.1, 0.1};
  const Run run(study);
  CAPTURE(run.outcome.out);
  CHECK(run.outcome.code == 0);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(run.pipeline(i)["summary"]["inconsistent_from"].is_null());
}

TEST_CASE("what is linear, written as formulas, is estimated as the linear observer does") {
  Json study = pendulum();
  Json& system = study["system"];
  system["f"] = {"0.9*angle + 0.2*rate", "rate - 0.3*angle + 0.5*torque + push"};
  const Run formulas(study);
  REQUIRE(formulas.outcome.code == 0);
  system = Json::parse(R"({"type": "lti", "A": [[0.9, 0.2], [-0.3, 1]], "B": [[0], [0.5]],
    "Bw": [[0], [1]], "C": [[1, 0]]})");
  for (const char* key : {"X0", "W", "V"}) system[key] = pendulum()["system"][key];
  for (Json& pipeline : study["pipelines"]) pipeline["observer"] = "prediction_correction";
  const Run linear(study);
  REQUIRE(linear.outcome.code == 0);
  const std::size_t constrained = 2;
  for (std::size_t k = 0; k <= 3; ++k) {  // before reductions, which see other generators
    CAPTURE(k);
    for (const char* side : {"lower", "upper"}) {
      for (std::size_t i = 0; i < 2; ++i) {
        const auto bound = [&](const Run& run) {
          return run.pipeline(constrained)["steps"][k]["hull"][side][i].get<double>();
        };
        CHECK(bound(formulas) == doctest::Approx(bound(linear)).epsilon(1e-9));
      }
    }
  }
}

TEST_CASE("MAT-files hold no formulas: studies are refused, results are written without them") {
  const Run run(pendulum());
  const test::Outcome study = run("convert s.json s.mat");
  CHECK(study.code == 2);
  CHECK(study.out.find("a system by formulas has no form in MAT-files") != std::string::npos);
  CHECK(run("convert out r.mat").code == 0);
}

TEST_CASE("the resolved study says the same") {
  const Run run(pendulum());
  REQUIRE(run.outcome.code == 0);
  const Json results = run.results();
  const Run again(results["study"]);
  REQUIRE(again.outcome.code == 0);
  CHECK(again.results()["study"] == results["study"]);
  CHECK(again.pipeline(2)["steps"][40]["hull"] == run.pipeline(2)["steps"][40]["hull"]);
}
