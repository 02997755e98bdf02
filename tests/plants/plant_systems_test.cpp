// SPDX-License-Identifier: GPL-3.0-or-later
// Studies whose system is a plant: the observer estimates what is simulated.
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "study/study_run.hpp"

using Json = nlohmann::ordered_json;
using Run = test::StudyRun;

namespace {

Json box(std::initializer_list<double> radii) {
  Json lower = Json::array(), upper = Json::array();
  for (const double radius : radii) {
    lower.push_back(-radius);
    upper.push_back(radius);
  }
  return {{"type", "box"}, {"lower", lower}, {"upper", upper}};
}

/// With the backends that keep it bounded.
Json study_of(std::initializer_list<const char*> backends, const Json& plant, const Json& X0,
              const Json& W, const Json& V, const Json& input) {
  Json study;
  study["cordon"] = 1;
  study["system"] = {{"type", "nonlinear"}, {"plant", plant}, {"X0", X0}, {"W", W}, {"V", V}};
  study["data"]["simulate"] = {{"steps", 20}, {"seed", 3}, {"input", {input}}};
  for (const char* backend : backends)
    study["pipelines"].push_back({{"backend", backend}, {"observer", "nonlinear"}});
  study["metrics"] = {"radius", "contains_truth"};
  return study;
}

Json tanks() {
  return study_of({"interval", "zonotope", "constrained_zonotope"},
                  {{"type", "coupled_tanks"}, {"substeps", 4}}, box({2, 2}), box({.01, .01}),
                  box({.05}), {{"type", "square"}, {"amplitude", .5}, {"period", 10}});
}

Json stirred_tank() {
  return study_of({"zonotope", "constrained_zonotope"},
                  {{"type", "stirred_tank"}, {"substeps", 10}}, box({.002, .5}), box({1e-5, .005}),
                  box({1e-4}), {{"type", "sine"}, {"amplitude", 2}, {"omega", .3}});
}

void expect_told(const Run& run, const std::string& what) {
  CAPTURE(run.outcome.out);
  CHECK(run.outcome.out.find(what) != std::string::npos);
}

}  // namespace

TEST_CASE("a plant as the system: the truth stays inside, and verification finds nothing") {
  for (const bool stirred : {false, true}) {
    for (const char* rounding : {"nominal", "outward"}) {
      Json study = stirred ? stirred_tank() : tanks();
      for (Json& pipeline : study["pipelines"]) {
        pipeline["name"] = pipeline["backend"];
        pipeline["backend"] = {{"type", pipeline["backend"]}, {"rounding", rounding}};
      }
      const Run run(study);
      CAPTURE(run.outcome.out);
      REQUIRE(run.outcome.code == 0);
      for (std::size_t i = 0; i < study["pipelines"].size(); ++i) {
        CHECK(run.pipeline(i)["summary"]["outside_from"].is_null());
        CHECK(run.pipeline(i)["summary"]["inconsistent_from"].is_null());
        CHECK(run.pipeline(i)["steps"].size() == 21);
      }
      const test::Outcome verified = run("verify out");
      CAPTURE(verified.out);
      CHECK(verified.code == 0);
      CHECK(verified.out.find("successors by formulas are drawn") != std::string::npos);
    }
  }
}

TEST_CASE("what is verified are the formulas that the run has left, without a plugin") {
  const Run run(tanks());
  REQUIRE(run.outcome.code == 0);
  const Json results = run.results();
  CHECK(results["study"]["system"]["plant"]["substeps"] == 4);
  CHECK(results["formulas"]["f"]["rows"].size() == 2);
  CHECK(results["formulas"]["g"]["rows"].size() == 1);
  CHECK(run("verify out --quiet").code == 0);
  // Another gravity beneath the root: other successors, some of them outside.
  const std::string node = "[\"constant\", 1962, 1962]";
  run.exchange(node, "[\"constant\", 1000, 1000]");
  CHECK(run("verify out --quiet").code == 4);
  // Sizes are those of the data.
  run.exchange("\"inputs\": 1,\n", "\"inputs\": 2,\n");
  CHECK(run("verify out").says("there is no column \"u_2\""));
  run.exchange("\"inputs\": 2,\n", "\"inputs\": -1,\n");
  CHECK(run("verify out").says("/formulas/inputs"));
  run.exchange("\"inputs\": -1,\n", "\"inputs\": 1,\n");
  run.exchange("[\"constant\", 1000, 1000]", "[\"sinh\", 1]");
  const test::Outcome unknown = run("verify out");
  CHECK(unknown.code == 2);
  CHECK(unknown.says("is no node of formulas"));
  run.exchange("[\"sinh\", 1]", "[\"sin\", 100]");
  CHECK(run("verify out").says("/formulas/f/nodes"));
  run.exchange("\"formulas\"", "\"formula\"");
  CHECK(run("verify out").says("is missing; \"cordon run\" writes the formulas of a plant"));
}

TEST_CASE("reports and MAT-files of such a run are written without the plugin") {
  const Run run(tanks());
  REQUIRE(run.outcome.code == 0);
  CHECK(run("report out").code == 0);
  CHECK(run("convert out out.mat").code == 0);
}

TEST_CASE("the resolved study is the same study") {
  const Run run(stirred_tank());
  REQUIRE(run.outcome.code == 0);
  const Json study = run.results()["study"];
  CHECK(study["system"]["plant"]["type"] == "stirred_tank");
  CHECK(study["system"]["plant"]["volume"] == 100);
  CHECK_FALSE(study["system"].contains("f"));
  const Run again(study);
  CAPTURE(again.outcome.out);
  REQUIRE(again.outcome.code == 0);
  CHECK(again.text("out/sets.jsonl") == run.text("out/sets.jsonl"));
  CHECK(again.results()["study"] == study);
}

TEST_CASE("parameters of the plant are swept") {
  Json study = tanks();
  study["sweep"] = Json::parse(R"([{"name": "steps", "path": "/system/plant/substeps",
                                    "values": [1, 2]}])");
  const Run run(study);
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  CHECK(run.results()["points"].size() == 2 * 3);
  CHECK_FALSE(run.results().contains("formulas"));  // every point has others
  CHECK(run("report out").code == 0);
  CHECK(run("convert out out.mat").code == 0);
}

TEST_CASE("the example is verified, every step of every pipeline") {
  const Run run(
      Json::parse(bytes_of(CORDON_SOURCE_DIR "/examples/studies/nonlinear_coupled_tanks.json")));
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  const test::Outcome verified = run("verify out --json");
  CAPTURE(verified.out);
  REQUIRE(verified.code == 0);
  const Json told = Json::parse(verified.out);
  CHECK(told["verified"] == true);
  CHECK(told["pipelines"].size() == 6);
  for (const Json& pipeline : told["pipelines"]) CHECK(pipeline["steps"] == 61);
}

TEST_CASE("what is wrong with a plant as a system is told at its place, all at once") {
  Json study = tanks();
  Json& system = study["system"];
  system["plant"] = {{"type", "coupled_tanks"}, {"substep", 4}};
  system["f"] = {"x1"};
  system["parameters"] = Json::object();
  system["A"] = Json::parse("[[1]]");
  study["data"]["simulate"]["plant"] = "coupled_tanks";
  const Run run(study);
  CHECK(run.outcome.code == 2);
  for (const char* what :
       {"/system/plant/substep", "did you mean \"substeps\"?", "/system/f",
        "cannot stand beside \"plant\", which brings its formulas", "/system/parameters",
        "/system/A (line", "/data/simulate/plant", "the formulas themselves are simulated"})
    expect_told(run, what);

  study = tanks();
  study["system"]["X0"] = box({1, 1, 1});
  study["system"]["V"] = box({1, 1});
  study["system"].erase("W");
  const Run sizes(study);
  CHECK(sizes.outcome.code == 2);
  for (const char* what :
       {"/system/X0", "has dimension 3, must have 2 like the states of /system/plant", "/system/V",
        "has dimension 2, must have 1 like the noises of /system/plant", "/system/W (line",
        "is missing"})
    expect_told(sizes, what);

  study = tanks();
  study["system"]["plant"]["substeps"] = 1000;
  expect_told(Run(study), "as formulas a plant has at most 500 substeps, and this one 1000");
  study["system"]["plant"] = "coupled_tank";
  expect_told(Run(study), "no plant \"coupled_tank\"");
  study["system"]["plant"] = {{"type", "coupled_tanks"}, {"voltage", 6}};
  expect_told(Run(study), "above the highest");
}

TEST_CASE("relaxations of a long integration are refused before they take the memory") {
  Json study = stirred_tank();
  study["system"]["plant"]["substeps"] = 100;
  study["pipelines"].erase(0);
  study["pipelines"][0]["observer"] = {{"type", "nonlinear"}, {"method", "relaxation"}};
  const Run run(study);
  CHECK(run.outcome.code == 2);
  expect_told(run, "/pipelines/0/observer/method");
  expect_told(run, "\"relaxation\" takes formulas of at most 2000 parts, and these have 7");
}

TEST_CASE("an input outside the range of the pump ends the simulation at its place") {
  Json study = tanks();
  study["data"]["simulate"]["input"][0]["amplitude"] = 4;
  const Run run(study);
  CHECK(run.outcome.code == 2);
  expect_told(run, "cannot be simulated at k = ");
}
