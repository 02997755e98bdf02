// SPDX-License-Identifier: GPL-3.0-or-later
// Linear models that are proven in a region: who uses them keeps to it, or ends.
#include <fstream>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/study/study.hpp"
#include "study/study_run.hpp"

using Json = nlohmann::ordered_json;
using Run = test::StudyRun;

namespace {

/// x⁺ = x/2 + u, |x| ≤ 2.
Json study() {
  return Json::parse(R"json({"cordon": 1,
    "system": {"type": "lti", "A": [[0.5]], "B": [[1]], "C": [[1]],
      "X0": {"type": "box", "lower": [-1], "upper": [1]},
      "W": {"type": "box", "lower": [-0.1], "upper": [0.1]},
      "V": {"type": "box", "lower": [-0.25], "upper": [0.25]},
      "region": {"states": {"lower": [-2], "upper": [2]}, "inputs": {"lower": [-3], "upper": [3]}}},
    "data": {"csv": {"file": "d.csv", "inputs": ["u"], "outputs": ["y"], "missing": "skip"}},
    "pipelines": [{"backend": "interval", "observer": "prediction_correction"},
                  {"backend": "zonotope", "observer": "luenberger"},
                  {"backend": "constrained_zonotope", "observer": "prediction_correction"}]})json");
}

/// Of a walk to 2.4, that is outside from k = 4 on.
constexpr const char* walk = "u,y\n0,0\n1,0\n1,1\n1.5,1.5\n0,2.25\n0,1.125\n";

std::string said(const Run& run, std::size_t pipeline) {
  const Json error = run.pipeline(pipeline)["summary"]["error"];
  return error.is_null() ? "" : error.get<std::string>();
}

/// Estimates before the end.
std::size_t steps(const Run& run, std::size_t pipeline) {
  return run.pipeline(pipeline)["steps"].size();
}

}  // namespace

TEST_CASE("the guarantee of a linear model ends where the state is not shown to be in the region") {
  const Run run(study(), walk);
  CAPTURE(run.outcome.out);
  CHECK(run.outcome.code == 2);
  for (std::size_t i = 0; i < 3; ++i) {
    CAPTURE(i);
    CHECK(steps(run, i) == 5);  // the estimate of k = 4 holds, the step from it does not
    CHECK(said(run, i).find("the linear model is proven where -2 <= x1 <= 2, and x1 may be") == 0);
    CHECK(said(run, i).find("at k = 4") != std::string::npos);
  }
  Json everywhere = study();
  everywhere["system"].erase("region");
  const Run other(everywhere, walk);
  CHECK(other.outcome.code == 0);
  CHECK(steps(other, 0) == 6);
}

TEST_CASE("an input outside the region ends it as well") {
  Json narrow = study();
  narrow["system"]["region"]["inputs"] = Json::parse(R"({"lower": [-1.25], "upper": [1.25]})");
  const Run run(narrow, walk);
  CHECK(steps(run, 0) == 4);
  CHECK(said(run, 0) ==
        "the linear model is proven where -1.25 <= u1 <= 1.25, and u1 is 1.5 at k = 3");
}

TEST_CASE("outputs that are not linear are used where the prediction is in the region alone") {
  // y = 2x - x² is x + d, d in [0, 1/4], where x is in [0, 1]. X0 reaches beyond, and the update by
  // y = 0.91 would lead back into the region without the true state, 1.3.
  Json bent = study();
  bent["system"]["X0"] = Json::parse(R"({"type": "box", "lower": [0.7], "upper": [1.4]})");
  bent["system"]["V"] = Json::parse(R"({"type": "box", "lower": [0], "upper": [0.25]})");
  bent["system"]["region"]["states"] = Json::parse(R"({"lower": [0], "upper": [1]})");
  const char* data = "u,y\n0,0.91\n0,0.6\n";
  const Run trusting(bent, data);
  CHECK(steps(trusting, 0) == 2);
  bent["system"]["region"]["nonlinear_outputs"] = true;
  const Run run(bent, data);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(steps(run, i) == 0);
    CHECK(said(run, i).find("0 <= x1 <= 1, and x1 may be 1.") != std::string::npos);
    CHECK(said(run, i).find("at k = 0") != std::string::npos);
  }
  // Without an output nothing is used of it.
  const Run unseen(bent, "u,y\n0,\n0,0.6\n");
  CHECK(steps(unseen, 0) == 1);
  bent["system"]["X0"]["upper"] = {0.9};
  const Run within(bent, "u,y\n0,0.91\n0.7,0.6\n0,0.9\n");
  CHECK(steps(within, 0) == 2);  // 0.55 / 2 + 0.7 + 0.1 is above 1
  CHECK(said(within, 0).find("x1 may be 1.0") != std::string::npos);
  CHECK(said(within, 0).find("at k = 2") != std::string::npos);
}

TEST_CASE("a mode whose region is not shown to hold is never excluded") {
  Json modes = study();
  modes["system"]["X0"] = Json::parse(R"({"type": "box", "lower": [1], "upper": [1.5]})");
  modes["system"]["V"] = Json::parse(R"({"type": "box", "lower": [-4], "upper": [4]})");
  modes["system"]["modes"] = Json::parse(R"([{"name": "grows", "system": {"type": "lti",
      "A": [[2]], "B": [[1]], "C": [[1]],
      "W": {"type": "box", "lower": [-0.1], "upper": [0.1]},
      "V": {"type": "box", "lower": [-4], "upper": [4]}}}])");
  for (Json& pipeline : modes["pipelines"]) {
    pipeline.erase("observer");
    pipeline["diagnoser"] = {{"type", "consistency_bank"}, {"observer", "prediction_correction"}};
  }
  const char* data = "u,y\n0,0\n0,0\n0,0\n0,0\n0,0\n0,0\n";  // 1, 2, 4, 8 is not seen as 0
  const auto excludes = [&](const Json& json) {
    const Run run(json, data);
    CAPTURE(run.outcome.out);
    REQUIRE(run.outcome.code == 0);
    bool found = false;
    const Json pipeline = run.pipeline(0);
    for (const Json& event : pipeline["summary"]["events"]) {
      CHECK((event["what"] != "excluded" || event["mode"] == "grows"));
      found = found || event["what"] == "excluded";
    }
    return found;
  };
  CHECK_FALSE(excludes(modes));
  const Run bank(modes, data);
  const Json told = bank.pipeline(0);
  std::string reason;
  for (const Json& event : told["summary"]["events"]) {
    if (event["what"] == "left_open" && event["mode"] == "grows")
      reason = std::to_string(event["k"].get<int>()) + ": " +
               event["evidence"]["left_open"].get<std::string>();
  }
  CHECK(reason.find("2: the linear model is proven where -2 <= x1 <= 2") == 0);
  CHECK(bank.outcome.out.find("left_open  grows") != std::string::npos);
  CHECK(bank.outcome.out.find("cannot be excluded any more: the linear") != std::string::npos);
  modes["system"].erase("region");
  CHECK(excludes(modes));
}

TEST_CASE("actuators that do less allow more input in the region") {
  Json modes = study();
  modes["system"]["modes"] = Json::parse(
      R"([{"name": "half", "actuator": [0.5]}, {"name": "weak", "actuator": [[0.1, 0.3]]},
                      {"name": "dead", "actuator": [0]}])");
  const Scratch scratch;
  scratch.write("d.csv", walk);
  cordon::Registry registry;
  registry.load({{CORDON_BINARY_DIR "/lib/cordon/plugins-v1"}});
  const cordon::Study read =
      cordon::read_study(scratch.write("s.json", modes.dump()), registry, {});
  const auto inputs = [&](std::size_t j) { return read.modes[j].model.region->inputs; };
  CHECK(inputs(0).lower[0] == -6);
  CHECK(inputs(0).upper[0] == 6);
  CHECK(inputs(1).upper[0] == doctest::Approx(10));
  CHECK(inputs(1).upper[0] * 0.3 <= 3);
  CHECK(inputs(2).upper[0] == cordon::infinity);
  CHECK(read.modes[2].model.region->states.upper[0] == 2);
  CHECK(read.resolved.find("\"region\"") != std::string::npos);
}

TEST_CASE("a bank of gains takes a region that the plant is shown never to leave") {
  Json modes = study();
  modes["system"]["U"] = Json::parse(R"({"type": "box", "lower": [0.7], "upper": [0.9]})");
  modes["system"]["modes"] = Json::parse(R"([{"name": "half", "actuator": [0.5]}])");
  modes["pipelines"] = Json::parse(
      R"([{"backend": "zonotope", "diagnoser": {"type": "observer_bank", "gain": [[0.4]]}}])");
  const char* data = "u,y\n0.8,0\n0.8,0.8\n0.8,1.2\n";
  modes["system"]["region"]["states"]["upper"] = {2.1};
  CHECK(Run(modes, data).outcome.code == 0);
  modes["system"]["region"]["states"]["upper"] = {1.9};  // (0.9 + 0.1) / (1 - 0.5) = 2
  const Run left(modes, data);
  CHECK(left.outcome.code == 2);
  CHECK(left.outcome.out.find("is not shown to hold at all times: x1 may be in [-1, 2]") !=
        std::string::npos);
  modes["system"]["region"]["states"]["upper"] = {2.1};
  modes["system"]["region"]["inputs"]["upper"] = {0.8};
  const Run input(modes, data);
  CHECK(input.outcome.code == 2);
  CHECK(input.outcome.out.find("u1 may be in [0.7, 0.9]") != std::string::npos);
}

TEST_CASE("designed inputs keep to the region") {
  const auto design = [](double reach) {
    Json wide = study();
    wide["system"]["region"]["states"] = {{"lower", {-reach}}, {"upper", {reach}}};
    wide["system"]["modes"] = Json::parse(R"([{"name": "half", "actuator": [0.5]}])");
    wide.erase("data");
    wide["pipelines"] = Json::parse(R"([{"backend": "constrained_zonotope",
        "designer": {"type": "facets", "horizon": 3,
                     "input_set": {"type": "box", "lower": [-2.5], "upper": [2.5]}}}])");
    return Run(wide);
  };
  const Run inside(design(4));
  CAPTURE(inside.outcome.out);
  CHECK(inside.outcome.code == 0);
  CHECK(inside.pipeline(0)["design"]["status"] == "optimal");
  const Run outside(design(0.9));  // X0 reaches further
  CAPTURE(outside.outcome.out);
  CHECK(outside.outcome.code != 0);
  CHECK(outside.pipeline(0)["design"]["status"] == "unknown");
  CHECK(outside.outcome.out.find("is not shown to lie in the region") != std::string::npos);
}

TEST_CASE("who cannot keep to a region refuses it, and mistakes are told at their places") {
  Json faults = study();
  faults["system"]["F"] = Json::parse("[[1]]");
  faults["pipelines"] = Json::parse(R"([{"backend": "interval",
      "diagnoser": {"type": "fault_estimation_filter"}}])");
  const Run refused(faults, walk);
  CHECK(refused.outcome.code == 2);
  CHECK(refused.outcome.out.find("takes models that hold for all states, and the system has a "
                                 "\"region\"") != std::string::npos);
  Json wrong = study();
  wrong["system"]["region"] =
      Json::parse(R"({"states": {"lower": [2], "upper": [-2]}, "speed": 1})");
  const Run told(wrong, walk);
  CHECK(told.outcome.code == 2);
  for (const char* what :
       {"/system/region/states/lower/0", "/system/region/inputs", "/system/region/speed"})
    CHECK(told.outcome.out.find(what) != std::string::npos);
  Json intervals = study();
  intervals["system"]["type"] = "interval_lti";
  CHECK(Run(intervals, walk).outcome.out.find("/system/region") != std::string::npos);
  const Run run(study(), walk);
  // The record leaves the region, of which no larger W is a consequence.
  CHECK(run("identify s.json --trade-off").out.find("proven in a region, which data may leave") !=
        std::string::npos);
  const test::Outcome sought = run("identify s.json --json");
  CAPTURE(sought.out);
  CHECK(sought.code == 0);
  CHECK(Json::parse(sought.out)["pipeline"] == "interval");
  const test::Outcome converted = run("convert s.json m.mat");
  CAPTURE(converted.out);
  CHECK(converted.code != 0);
  CHECK(converted.out.find("has no form in MAT-files") != std::string::npos);
}
