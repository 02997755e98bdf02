// SPDX-License-Identifier: GPL-3.0-or-later
// When data and model disagree: why an estimate is empty, outputs that are left out as outliers,
// and observers that begin anew.
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "study/study_run.hpp"

using Json = nlohmann::ordered_json;
using test::Outcome;

namespace {

const char* const backends[] = {"interval", "zonotope", "constrained_zonotope", "line_zonotope"};
const char* const observers[] = {"prediction_correction", "gain_correction",     "luenberger",
                                 "zonotope_uncertain",    "interval_trajectory", "integrated"};

using Run = test::StudyRun;

/// Two levels with two gauges, and outliers that no bound overlooks.
Json tanks(std::int64_t seed, double shift) {
  Json study = Json::parse(R"({"cordon": 1, "title": "outliers", "system": {"type": "lti",
    "A": [[0.9, 0.05], [0.1, 0.8]], "B": [[0.1], [0]], "C": [[1, 0], [0, 1]],
    "names": {"outputs": ["gauge 1 [m]", "gauge 2 [m]"]},
    "X0": {"type": "box", "lower": [0, 0], "upper": [1, 1]},
    "W": {"type": "box", "lower": [-0.01, -0.01], "upper": [0.01, 0.01]},
    "V": {"type": "box", "lower": [-0.05, -0.05], "upper": [0.05, 0.05]}},
    "data": {"simulate": {"steps": 40, "input": [{"type": "sine", "amplitude": 1, "omega": 0.2}],
      "outliers": [{"probability": 0.06}]}},
    "pipelines": [], "metrics": ["contains_truth"]})");
  study["data"]["simulate"]["seed"] = seed;
  study["data"]["simulate"]["outliers"][0]["shift"] = shift;
  return study;
}

void add_pipelines(Json& study, const Json& options) {
  for (const char* backend : backends) {
    for (const char* observer : observers) {
      Json spec = {{"type", observer}};
      if (std::string(observer) != "prediction_correction")
        spec["gain"] = Json::parse("[[0.4, 0], [0, 0.4]]");
      Json pipeline = {{"name", std::string(backend) + " " + observer},
                       {"backend", backend},
                       {"observer", spec}};
      pipeline.update(options);
      study["pipelines"].push_back(std::move(pipeline));
    }
  }
}

/// x⁺ = x / 2 + w, y = x + v, as recorded.
Json recorded(const Json& options, const char* backend = "constrained_zonotope") {
  Json study = Json::parse(R"({"cordon": 1, "title": "a jump", "system": {"type": "lti",
    "A": [[0.5]], "C": [[1]], "names": {"outputs": ["gauge [m]"]}, "sampling_time": 2,
    "X0": {"type": "box", "lower": [-1], "upper": [1]},
    "W": {"type": "box", "lower": [-0.1], "upper": [0.1]},
    "V": {"type": "box", "lower": [-0.1], "upper": [0.1]}},
    "data": {"csv": {"file": "d.csv", "outputs": ["y"]}},
    "pipelines": [{"name": "P", "observer": "prediction_correction"}]})");
  study["pipelines"][0]["backend"] = backend;
  study["pipelines"][0].update(options);
  return study;
}

constexpr const char* jump = "y\n0\n1\n0.5\n0.25\n";
constexpr const char* two_outliers = "y\n0\n1\n0\n1\n0\n";

}  // namespace

TEST_CASE("an empty estimate tells the sample, the output, and by how much it misses") {
  for (const char* backend : backends) {
    const Run run(recorded(Json::object(), backend), jump);
    CAPTURE(run.outcome.out);
    CHECK(run.outcome.code == 0);
    // x_0 within 0.1 of 0, x_1 within 0.15, y_1 within 0.25
    CHECK(run.outcome.says("P: Empty: at k = 1 (2 s) gauge [m] lies 0.7"));
    CHECK(run.outcome.says(" beyond its prediction."));
    const Json found = run.pipeline()["summary"]["contradiction"];
    CHECK(found["k"] == 1);
    CHECK(found["output"] == 1);
    const bool encloses = std::string(backend) == "zonotope";  // strips by more than there is
    CHECK(found["distance"].get<double>() == doctest::Approx(.75).epsilon(encloses ? .01 : 1e-9));
    CHECK(run.pipeline()["summary"]["inconsistent"] == 3);
  }
}

TEST_CASE("outliers that are left out take no truth from any observer") {
  std::int64_t samples = 0;
  for (std::int64_t seed = 1; seed <= 4; ++seed) {
    Json study = tanks(seed, 30);
    add_pipelines(study, {{"outliers", {{"most", 20}, {"in", 40}}}});
    const Run run(study);
    CAPTURE(seed);
    CAPTURE(run.outcome.out);
    CHECK(run.outcome.code == 0);
    CHECK_FALSE(run.outcome.says("Assumption failed"));
    for (std::size_t p = 0; p < study["pipelines"].size(); ++p) {
      const Json summary = run.pipeline(p)["summary"];
      CAPTURE(study["pipelines"][p]["name"].get<std::string>());
      CHECK(summary["contains_truth_yes"] == 41);
      CHECK(summary["inconsistent"] == 0);
      if (summary.contains("outliers"))
        samples += summary["outliers"]["samples"].get<std::int64_t>();
    }
    const Outcome verified = run("verify out --directions 2");
    CHECK_MESSAGE(verified.code == 0, verified.out);
  }
  CHECK(samples > 4 * 20);
}

TEST_CASE("the message of an outlier names all outputs that are left out with it") {
  Json study = recorded({{"outliers", {{"most", 1}, {"in", 2}}}});
  study["system"].update(
      {{"C", {{1}, {1}}},
       {"names", {{"outputs", {"gauge [m]", "float [m]"}}}},
       {"V", {{"type", "box"}, {"lower", {-0.1, -0.1}}, {"upper", {0.1, 0.1}}}}});
  study["data"]["csv"]["outputs"] = {"y", "z"};
  const Run run(study, "y,z\n0,0\n1,1\n0,0\n");
  CHECK_MESSAGE(run.outcome.says("(gauge [m] and float [m] left out)"), run.outcome.out);
}

TEST_CASE("outliers that are used are an assumption that fails, and no defect") {
  Json study = tanks(1, 30);
  add_pipelines(study, Json::object());
  const Run run(study);
  CHECK(run.outcome.code == 0);
  CHECK_MESSAGE(run.outcome.says("no v in V of mode"), run.outcome.out);
  CHECK_MESSAGE(run.outcome.says("[m] lies "), run.outcome.out.substr(0, 4000));
  const Outcome verified = run("verify out --directions 2");
  CHECK_MESSAGE(verified.code == 0, verified.out);
}

TEST_CASE("beyond the limit of outliers the estimate is empty") {
  const Json once{{"outliers", {{"most", 1}, {"in", 3}}}};
  const Run all(recorded({{"outliers", {{"most", 1}, {"in", 2}}}}), two_outliers),
      one(recorded(once), two_outliers);
  CHECK(all.pipeline()["summary"]["inconsistent"] == 0);
  CHECK(all.pipeline()["summary"]["outliers"]["samples"] == 2);
  CHECK(all.pipeline()["steps"][1]["left_out"] == Json::array({1}));
  CHECK_FALSE(all.pipeline()["steps"][2].contains("left_out"));
  CHECK_MESSAGE(all.outcome.says("P: outputs of 2 samples left out as outliers"), all.outcome.out);
  CHECK(one.pipeline()["summary"]["inconsistent_from"] == 3);
  CHECK(one.pipeline()["summary"]["outliers"]["samples"] == 1);
  for (const Run* run : {&all, &one}) CHECK((*run)("verify out").code == 0);
}

TEST_CASE("an observer begins anew with the sample after an empty estimate") {
  const Json set{{"type", "box"}, {"lower", {-2}}, {"upper", {2}}};
  for (const char* backend : backends) {
    const Run run(recorded({{"on_empty", "restart"}, {"restart_set", set}}, backend), jump);
    CAPTURE(run.outcome.out);
    CHECK(run.outcome.code == 0);
    CHECK(run.outcome.says("1 empty set, begun anew"));
    CHECK(run.outcome.says("P: begun once anew from the restart set"));
    const Json pipeline = run.pipeline();
    CHECK(pipeline["summary"]["restarts"] == 1);
    CHECK(pipeline["summary"]["inconsistent"] == 1);
    const double slack = std::string(backend) == "zonotope" ? .02 : 1e-9;
    CHECK(pipeline["steps"][2]["hull"]["lower"][0].get<double>() ==
          doctest::Approx(.4).epsilon(slack));
    CHECK(pipeline["steps"][2]["hull"]["upper"][0].get<double>() ==
          doctest::Approx(.6).epsilon(slack));
    CHECK_MESSAGE(run("verify out").code == 0, run("verify out").out);
  }
  // from the measurement alone, where the representation holds the whole space
  const Run anywhere(recorded({{"on_empty", "restart"}}, "line_zonotope"), jump);
  CHECK(anywhere.pipeline()["steps"][2]["hull"]["lower"][0].get<double>() == doctest::Approx(.4));
  CHECK(anywhere("verify out").code == 0);
  const Run bounded(recorded({{"on_empty", "restart"}}, "zonotope"), jump);
  CHECK(bounded.outcome.code == 2);
  CHECK_MESSAGE(bounded.outcome.says("give a \"restart_set\""), bounded.outcome.out);
}

TEST_CASE("a restart set that does not hold the state is an assumption that fails") {
  Json study = tanks(3, 30);
  const Json narrow{{"type", "box"}, {"lower", {5, 5}}, {"upper", {6, 6}}};
  add_pipelines(study, {{"on_empty", "restart"}, {"restart_set", narrow}});
  const Run run(study);
  CHECK(run.outcome.code == 0);
  CHECK(run.outcome.says("Assumption failed"));
}

TEST_CASE("what is left out and where an observer begins anew is checked") {
  const Run run(recorded({{"outliers", {{"most", 1}, {"in", 2}}}}), two_outliers);
  run.exchange("\"left_out\": [1]", "\"left_out\": [2]");
  CHECK(run("verify out").code == 2);
  const Run none(recorded({{"outliers", {{"most", 1}, {"in", 2}}}}), two_outliers);
  none.exchange(", \"left_out\": [1]", "");
  CHECK(none("verify out").code == 5);  // no state fits the sample: nothing is known to be lost
}

TEST_CASE("options that do not fit") {
  const auto refused = [](const Json& options, const std::string& message) {
    const Run run(recorded(options), jump);
    CHECK(run.outcome.code == 2);
    CHECK_MESSAGE(run.outcome.says(message), run.outcome.out);
  };
  refused({{"on_empty", "restrat"}}, "did you mean \"restart\"?");
  refused({{"restart_set", {{"type", "point"}, {"center", {0}}}}}, "is not used");
  refused({{"on_empty", "restart"}, {"restart_set", {{"type", "point"}, {"center", {0, 0}}}}},
          "has dimension 2, the state has 1");
  refused({{"outliers", {{"most", 3}, {"in", 2}}}}, "is larger than \"in\"");
  refused({{"outliers", {{"most", 3}}}}, "/pipelines/0/outliers/in");
  refused({{"outliers", 3}}, "/pipelines/0/outliers");
  Json bank = recorded(Json::object());
  bank["pipelines"][0].erase("observer");
  bank["pipelines"][0]["diagnoser"] = {
      {"type", "consistency_bank"}, {"observer", "prediction_correction"}, {"waiting_time", 1}};
  bank["pipelines"][0]["on_empty"] = "restart";
  CHECK(Run(bank, jump).outcome.says("belongs to pipelines with an observer"));
}
