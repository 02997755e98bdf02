// SPDX-License-Identifier: GPL-3.0-or-later
// Estimates that lag are reported as what they are: of their own times, against the truth of these,
// and held against the states that later samples leave.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

namespace {

using Json = nlohmann::ordered_json;
using test::Outcome;

Outcome program(const std::string& arguments) { return test::cordon_with(arguments + " 2>&1"); }

Json study_of(const std::string& data, Json pipelines) {
  Json study{{"cordon", 1}, {"title", "late"}};
  study["system"] = Json::parse(R"({"type": "lti", "A": [[0.9, 0.2], [-0.2, 0.8]],
    "B": [[0.1], [0.3]], "Bw": [[0.05], [0.1]], "C": [[1, 0]], "Dv": [[0.05]],
    "X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
    "W": {"type": "box", "lower": [-1], "upper": [1]},
    "V": {"type": "box", "lower": [-1], "upper": [1]}})");
  study["data"]["simulate"] = Json::parse(data);
  study["data"]["simulate"]["input"] =
      Json::parse(R"([{"type": "sine", "amplitude": 1, "omega": 0.7}])");
  study["pipelines"] = std::move(pipelines);
  study["metrics"] = {"contains_truth"};
  return study;
}

Json late(int lag, const std::string& more = "{}") {
  Json one{{"name", "late"}, {"backend", "constrained_zonotope"}};
  one["observer"] = {
      {"type", "fixed_lag"}, {"lag", lag}, {"max_generators", 60}, {"max_constraints", 20}};
  one.update(Json::parse(more));
  return one;
}

/// Runs it in a directory of its own.
class Run {
 public:
  explicit Run(const Json& study) {
    std::ofstream(home_ / "study.json") << study.dump(1);
    ran = program("run --out " + out() + " " + (home_ / "study.json").string());
    if (std::filesystem::exists(home_ / "out" / "results.json"))
      results = Json::parse(std::ifstream(home_ / "out" / "results.json"));
  }
  std::string out() const { return (home_ / "out").string(); }
  Json steps(std::size_t pipeline = 0) const { return results["pipelines"][pipeline]["steps"]; }
  /// The step at k, and its set, from another run.
  void take_step(const Run& other, std::size_t k, const std::string& tightness) {
    Json step = other.steps()[k];
    step["tightness"] = tightness;
    results["pipelines"][0]["steps"][k] = step;
    write();
    std::vector<std::string> lines = lines_of("sets.jsonl");
    Json set = Json::parse(other.lines_of("sets.jsonl")[k]);
    set["tightness"] = tightness;
    lines[k] = set.dump();
    std::ofstream file(home_ / "out" / "sets.jsonl");
    for (const std::string& line : lines) file << line << "\n";
  }
  std::vector<std::string> lines_of(const std::string& name) const {
    std::ifstream file(home_ / "out" / name);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
  }
  void write() const {
    std::filesystem::remove(home_ / "out" / "manifest.json");  // which knows it as it was
    std::ofstream(home_ / "out" / "results.json") << results.dump();
  }

  Outcome ran;
  Json results;

 private:
  Scratch home_;
};

}  // namespace

TEST_CASE("every time has one estimate, but for the last ones") {
  const Run run(study_of(R"({"steps": 30, "seed": 1, "noise": "uniform"})",
                         Json::array({late(4),
                                      {{"name", "now"},
                                       {"backend", "constrained_zonotope"},
                                       {"observer", "prediction_correction"}}})));
  CAPTURE(run.ran.out);
  CHECK(run.ran.code == 0);
  CHECK(run.ran.out.find("late: its last step is 4 steps before the last sample") !=
        std::string::npos);
  const Json steps = run.steps(), present = run.steps(1);
  REQUIRE(present.size() > 4);
  REQUIRE(steps.size() == present.size() - 4);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    CHECK(steps[i]["k"] == i);
    CHECK(steps[i]["contains_truth"] == "yes");
    for (std::size_t x = 0; x < 2; ++x) {
      const double low = steps[i]["hull"]["lower"][x], other = present[i]["hull"]["lower"][x];
      if (i < 4) CHECK(low >= other - 1e-9);  // nothing is reduced yet
    }
  }
  const Json assumptions = run.results["pipelines"][0]["assumptions"];
  CHECK(assumptions["lag"] == 4);
  CHECK(assumptions["follows_its_sets"] == false);
  CHECK_FALSE(run.results["pipelines"][1]["assumptions"].contains("lag"));
  const Outcome verified = program("verify " + run.out());
  CAPTURE(verified.out);
  CHECK(verified.code == 0);
  CHECK(verified.out.find("not re-checked") == std::string::npos);
  const Json told = Json::parse(test::cordon_with("verify --json " + run.out()).out);
  const Json checked = told["pipelines"][0];
  CHECK(checked["steps"] == steps.size());
  CHECK(checked["by_polytopes"] == steps.size());
  CHECK(checked["exact_claims"].get<int>() > 0);
  CHECK(checked["undecided"] == 0);
}

TEST_CASE("a set smaller than what later samples leave, or larger and called exact, is found") {
  const auto run_of = [](int lag) {
    return study_of(R"({"steps": 14, "seed": 3})", Json::array({late(lag)}));
  };
  const Run narrow(run_of(5)), wide(run_of(1));
  REQUIRE(narrow.ran.code == 0);
  REQUIRE(wide.ran.code == 0);
  const auto verified = [&](int lag, const Run& other, const std::string& tightness) {
    Run changed(run_of(lag));
    changed.take_step(other, 0, tightness);
    return program("verify " + changed.out());
  };
  const Outcome missing = verified(1, narrow, "outer"), larger = verified(5, wide, "exact");
  CAPTURE(missing.out);
  CAPTURE(larger.out);
  CHECK(missing.code == 4);
  CHECK(missing.out.find("k = 0") != std::string::npos);
  CHECK(larger.code == 4);
  CHECK(larger.out.find("exact") != std::string::npos);
  CHECK(verified(5, wide, "outer").code == 0);
}

TEST_CASE("a changed bound of an estimate that lags is found by its proof") {
  Run run(study_of(R"({"steps": 12, "seed": 1})", Json::array({late(2)})));
  REQUIRE(run.ran.code == 0);
  Json& upper = run.results["pipelines"][0]["steps"][5]["hull"]["upper"][0];
  upper = upper.get<double>() - .01;
  run.write();
  const Outcome verified = program("verify " + run.out());
  CAPTURE(verified.out);
  CHECK(verified.code == 4);
  CHECK(verified.out.find("k = 5") != std::string::npos);
}

TEST_CASE("where the exact set is next to a point at 0, what is left of larger terms is rounding") {
  const auto expect_held = [](Json study) {
    study["metrics"] = {"contains_truth"};
    const Run run(study);
    CAPTURE(run.ran.out);
    REQUIRE(run.ran.code == 0);
    const Outcome verified = program("verify " + run.out());
    CAPTURE(verified.out);
    CHECK(verified.code == 0);
  };
  Json at_rest{{"cordon", 1}, {"title", "at rest"}};
  at_rest["system"] = Json::parse(R"({"type": "lti", "A": [[1, 0.1], [0, 1]], "C": [[1, 0]],
    "Dv": [[0]], "Bw": [[0], [0]], "W": {"type": "point", "center": [0]},
    "V": {"type": "point", "center": [0]},
    "X0": {"type": "box", "lower": [-1000, -100], "upper": [1000, 100]}})");
  at_rest["data"]["simulate"] = Json::parse(R"({"steps": 12, "seed": 1, "x0": [0, 0]})");
  at_rest["pipelines"] = Json::array();
  for (const int lag : {1, 2, 3}) {
    for (const char* backend : {"line_zonotope", "constrained_zonotope"}) {
      Json one{{"name", std::string(backend) + " " + std::to_string(lag)}, {"backend", backend}};
      one["observer"] = {{"type", "fixed_lag"}, {"lag", lag}, {"max_generators", 60}};
      at_rest["pipelines"].push_back(one);
    }
  }
  expect_held(at_rest);
  Json without_noise = at_rest;
  without_noise["system"] = Json::parse(R"({"type": "lti",
    "A": [[0.02, 0.3], [0.04893178099401, -0.5]],
    "C": [[-0.7, 1.1], [-1.204594238352052, 0.43]],
    "Dv": [[-0.3, -0.5], [0.279422922619666, 0.684944126884138]],
    "Bw": [[-0.078, -0.754737010501892], [-0.723, 0]],
    "W": {"type": "box", "lower": [-0.6028763916372448, -0.6028763916372448],
      "upper": [0.790248994624419, 0.790248994624419]},
    "V": {"type": "point", "center": [0, 0]},
    "X0": {"type": "box", "lower": [-10000, -10000], "upper": [10000, 10000]}})");
  without_noise["data"]["simulate"] =
      Json::parse(R"({"steps": 12, "seed": 140, "noise": "uniform"})");
  without_noise["pipelines"] = Json::array(
      {{{"name", "late"},
        {"backend", "constrained_zonotope"},
        {"observer",
         {{"type", "fixed_lag"}, {"lag", 3}, {"max_generators", 60}, {"max_constraints", 5}}}}});
  expect_held(without_noise);
}

TEST_CASE("fewer samples than the lag: no estimate, and no error") {
  const Run run(study_of(R"({"steps": 3, "seed": 1})", Json::array({late(10)})));
  CAPTURE(run.ran.out);
  CHECK(run.ran.code == 0);
  CHECK(run.steps().empty());
  CHECK(run.ran.out.find("no step: no more samples than it lags by") != std::string::npos);
}

TEST_CASE("gaps, outliers and new beginnings") {
  Json study = study_of(
      R"({"steps": 60, "seed": 2, "dropouts": [{"outputs": [1], "every": 3}],
          "outliers": [{"outputs": [1], "probability": 0.1, "shift": 3}]})",
      Json::array({late(3, R"({"on_empty": "restart", "restart_set":
          {"type": "box", "lower": [-5, -5], "upper": [5, 5]}})")}));
  const auto expect_times_ascend = [](const Json& steps) {
    for (std::size_t i = 1; i < steps.size(); ++i) {
      const int before = steps[i - 1]["k"], now = steps[i]["k"];
      CHECK(before < now);
    }
  };
  const Run anew(study);
  CAPTURE(anew.ran.out);
  CHECK(anew.ran.code == 0);
  expect_times_ascend(anew.steps());
  CHECK(anew.results["pipelines"][0]["summary"]["restarts"].get<int>() > 0);
  CHECK(program("verify " + anew.out()).code == 0);
  study["pipelines"][0].erase("on_empty");
  study["pipelines"][0].erase("restart_set");
  study["pipelines"][0]["outliers"] = {{"most", 20}, {"in", 30}};
  const Run robust(study);
  CAPTURE(robust.ran.out);
  CHECK(robust.ran.code == 0);
  expect_times_ascend(robust.steps());
  for (const Json& step : robust.steps()) {
    CHECK(step["contains_truth"] != "no");
    CHECK_FALSE(step.contains("left_out"));
  }
  CHECK(robust.results["pipelines"][0]["summary"]["outliers"]["samples"].get<int>() > 0);
  CHECK(program("verify " + robust.out()).code == 0);
}
