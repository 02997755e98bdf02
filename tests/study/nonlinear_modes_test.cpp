// SPDX-License-Identifier: GPL-3.0-or-later
// Modes of systems by formulas: read, simulated, told apart by a bank.
#include <cmath>
#include <fstream>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/study/data.hpp"
#include "study/checks/assumption_check.hpp"
#include "study/study_run.hpp"

using Json = nlohmann::ordered_json;
using Run = test::StudyRun;

namespace {

/// Two tanks, either of which may leak, with a pipe that may be blocked.
Json tanks() {
  return Json::parse(R"json({"cordon": 1, "title": "tanks",
    "system": {"type": "nonlinear", "states": ["x1", "x2"], "inputs": ["u1"],
      "disturbances": ["w1", "w2"], "noises": ["v1", "v2"],
      "parameters": {"a1": 0.3, "a2": 0.25, "k1": 0.5, "l1": 0, "l2": 0},
      "f": ["x1 + k1*u1 - (a1 + l1)*sqrt(x1) + w1",
            "x2 + a1*sqrt(x1) - (a2 + l2)*sqrt(x2) + w2"],
      "g": ["x1 + v1", "x2 + v2"],
      "X0": {"type": "box", "lower": [3.5, 4.5], "upper": [4.5, 5.5]},
      "W": {"type": "box", "lower": [-0.01, -0.01], "upper": [0.01, 0.01]},
      "V": {"type": "box", "lower": [-0.05, -0.05], "upper": [0.05, 0.05]},
      "modes": [{"name": "leak_1", "parameters": {"l1": 0.012}},
                {"name": "leak_2", "f": {"x2": "x2 + a1*sqrt(x1) - (a2 + 0.012)*sqrt(x2) + w2"}},
                {"name": "blocked", "parameters": {"a1": 0.288}}]},
    "data": {"simulate": {"steps": 40, "seed": 7, "x0": [4.2, 5.1],
      "input": [{"type": "square", "offset": 1.1, "amplitude": 0.1, "period": 8}]}}})json");
}

Json with_banks(Json study) {
  for (const char* backend : {"interval", "zonotope", "constrained_zonotope"}) {
    study["pipelines"].push_back(
        {{"name", backend},
         {"backend", backend},
         {"diagnoser",
          {{"type", "consistency_bank"}, {"observer", "nonlinear"}, {"waiting_time", 15}}}});
  }
  return study;
}

/// k at which the pipeline excludes the mode first; -1: never.
int excluded_at(const Json& pipeline, const std::string& mode) {
  for (const Json& event : pipeline["summary"]["events"])
    if (event["what"] == "excluded" && event["mode"] == mode) return event["k"].get<int>();
  return -1;
}

}  // namespace

TEST_CASE("two tanks of which one leaks: as soon as an independent computation, or sooner") {
  std::ifstream in(CORDON_SOURCE_DIR "/tests/study/two_tank_leak.json");
  const Json reference = Json::parse(in);
  for (const Json& of : reference["cases"]) {
    CAPTURE(of["true_mode"].get<std::string>());
    Json study = with_banks(tanks());
    study["data"] =
        Json::parse(R"({"csv": {"file": "d.csv", "inputs": ["u"], "outputs": ["y1", "y2"]}})");
    std::string csv = "u,y1,y2\n";
    for (std::size_t k = 0; k < of["y"].size(); ++k)
      csv += reference["u"][k][0].dump() + "," + of["y"][k][0].dump() + "," + of["y"][k][1].dump() +
             "\n";
    const Run run(study, csv);
    CAPTURE(run.outcome.out);
    REQUIRE(run.outcome.code == 0);
    for (std::size_t i = 0; i < 3; ++i) {
      const Json pipeline = run.pipeline(i);
      for (const auto& [mode, wanted] :
           of["excluded_at"][pipeline["name"].get<std::string>()].items()) {
        CAPTURE(mode);
        const int found = excluded_at(pipeline, mode);
        if (wanted.is_null()) {
          CHECK(found == -1);
        } else {
          CHECK(found >= 0);
          CHECK(found <= wanted.get<int>());
        }
      }
    }
  }
}

TEST_CASE("whenever which mode begins, the truth is not excluded") {
  for (const char* mode : {"leak_1", "leak_2", "blocked"}) {
    for (const int from : {0, 1, 7, 20}) {
      CAPTURE(std::string(mode));
      CAPTURE(from);
      Json study = with_banks(tanks());
      study["data"]["simulate"]["faults"] = {{{"mode", mode}, {"from", from}}};
      study["data"]["simulate"]["noise"] = "vertex";
      study["data"]["simulate"]["seeds"] = 20;
      const Run run(study);
      CAPTURE(run.outcome.out);
      REQUIRE(run.outcome.code == 0);
      std::size_t never = 0, at = 0;
      while ((at = run.outcome.out.find("True mode excluded: never", at + 1)) != std::string::npos)
        ++never;
      CHECK(never == 3);
    }
  }
}

TEST_CASE("tubes of formulas leave the true mode and exclude the others") {
  for (const char* mode : {"healthy", "leak_1", "leak_2", "blocked"}) {
    CAPTURE(std::string(mode));
    Json study = tanks();
    if (std::string(mode) != "healthy")
      study["data"]["simulate"]["faults"] = {{{"mode", mode}, {"from", 0}}};
    study["data"]["simulate"]["steps"] = 12;
    study["data"]["simulate"]["noise"] = "vertex";
    study["data"]["simulate"]["seeds"] = 20;
    study["data"]["simulate"]["x0"] =
        Json::parse(R"({"type": "box", "lower": [3.5, 4.5], "upper": [4.5, 5.5]})");
    study["pipelines"] = Json::parse(R"([{"name": "tubes", "backend": "zonotope",
        "diagnoser": {"type": "tube_membership", "horizon": 12}}])");
    const Run run(study);
    CAPTURE(run.outcome.out);
    REQUIRE(run.outcome.code == 0);
    CHECK(run.outcome.out.find("True mode excluded: never") != std::string::npos);
    for (const char* other : {"healthy", "leak_1", "leak_2", "blocked"}) {
      const int at = excluded_at(run.pipeline(0), other);
      CHECK((std::string(other) == mode) == (at < 0));
      CHECK(at <= 9);
    }
  }
}

TEST_CASE("resolved studies with modes by formulas say the same") {
  Json study = with_banks(tanks());
  study["data"]["simulate"]["faults"] = {{{"mode", "leak_2"}, {"from", 10}}};
  study["system"]["modes"][0]["W"] =
      Json::parse(R"({"type": "box", "lower": [-0.02, -0.02], "upper": [0.02, 0.02]})");
  const Run run(study);
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  const Run again(run.results()["study"]);
  CAPTURE(again.outcome.out);
  REQUIRE(again.outcome.code == 0);
  CHECK(again.results()["study"] == run.results()["study"]);
  CHECK(again.pipeline(2)["summary"] == run.pipeline(2)["summary"]);
}

TEST_CASE("a leak of unknown size is a mode: isolated, and its size enclosed") {
  Json study = with_banks(tanks());
  study["system"]["parameters"]["l1"] = {{"lower", 0}, {"upper", 0}};
  study["system"]["modes"][0]["parameters"]["l1"] = {{"lower", 0.006}, {"upper", 0.02}};
  study["system"]["modes"].erase(2);
  study["data"]["simulate"]["x0"] = {4.2, 5.1, 0};
  study["data"]["simulate"]["faults"] = {{{"mode", "leak_1"}, {"from", 10}}};
  for (Json& pipeline : study["pipelines"]) {
    pipeline["diagnoser"]["start"] = "nominal";
    pipeline["diagnoser"]["restart_set"] =
        Json::parse(R"({"type": "box", "lower": [0, 0, 0], "upper": [10, 10, 0.02]})");
  }
  const Run run(study);
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Json pipeline = run.pipeline(i);
    bool isolated = false;
    const auto encloses = [](const Json& hull) {
      return hull["lower"][2].get<double>() <= 0.013 && hull["upper"][2].get<double>() >= 0.013;
    };
    for (const Json& event : pipeline["summary"]["events"]) {
      if (event["what"] != "isolated" || event["mode"] != "leak_1") continue;
      isolated = true;
      CHECK(encloses(event["estimate"]));
    }
    CHECK(isolated);
    const Json& last = pipeline["summary"]["last_state"];
    CHECK(last["mode"] == "leak_1");
    CHECK(last["k"] == study["data"]["simulate"]["steps"]);
    CHECK(last["since"] >= 10);  // the reset after the change, from which the hull holds
    CHECK(encloses(last["hull"]));
    const double width =
        last["hull"]["upper"][2].get<double>() - last["hull"]["lower"][2].get<double>();
    CHECK(width <= 0.0140001);
    if (pipeline["backend"] == "constrained_zonotope") CHECK(width < 0.013);  // products narrow it
  }
}

TEST_CASE("where a mode begins its parameters are new, which excuses and accuses nothing") {
  Json json = with_banks(tanks());
  json["system"]["parameters"]["l1"] = {{"lower", 0}, {"upper", 0}};
  json["system"]["modes"][0]["parameters"]["l1"] = {{"lower", 0.006}, {"upper", 0.02}};
  json["data"]["simulate"]["x0"] = {4.2, 5.1, 0};
  json["data"]["simulate"]["faults"] = {{{"mode", "leak_1"}, {"from", 10}}};
  const Scratch scratch;
  cordon::Registry registry;
  registry.load({{CORDON_BINARY_DIR "/lib/cordon/plugins-v1"}});
  const cordon::Study study = cordon::read_study(scratch.write("s.json", json.dump()), registry);
  cordon::detail::PipelineAssumptions assumed;
  assumed.exact_data = true;
  cordon::detail::AssumptionCheck check(study, assumed);
  check.begin_run(0);
  const auto data = cordon::open_data(study);
  while (auto record = data->next()) {
    if (record->sample.k == 20)  // an output that the bounds miss in its last digit
      record->sample.y[0] = std::nextafter((*record->truth)[0] + 0.05, 100);
    check.step(*record);
  }
  CHECK(check.excuses_by_rounding(20, true, 0));
}

TEST_CASE("a truth that leaves the admissible set is a failed assumption, not a defect") {
  Json study = with_banks(tanks());
  study["system"]["admissible"] = {{"type", "box"}, {"lower", {3.9, 0}}, {"upper", {12, 12}}};
  const Run run(study);
  CAPTURE(run.outcome.out);
  CHECK(run.outcome.code == 0);
  CHECK(run.outcome.out.find("Assumption failed: x_") != std::string::npos);
  CHECK(run.outcome.out.find("lies outside an admissible set") != std::string::npos);
  for (std::size_t i = 0; i < 3; ++i) {
    const Json failed = run.pipeline(i)["summary"]["failed_assumption"];
    CHECK(failed["what"] == "admissible_set");
    CHECK(excluded_at(run.pipeline(i), "healthy") >= failed["k"].get<int>());
  }
}

TEST_CASE("a mode whose formulas are not defined is never excluded, and does not end the others") {
  Json study = with_banks(tanks());
  study["system"]["modes"].push_back(
      {{"name", "odd"}, {"f", {{"x1", "x1 + k1*u1 - a1*sqrt(x1 - 4.2) + w1"}}}});
  const Run run(study);
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(excluded_at(run.pipeline(i), "odd") == -1);
    CHECK(excluded_at(run.pipeline(i), "healthy") == -1);
    CHECK(excluded_at(run.pipeline(i), "blocked") >= 0);
  }
}

TEST_CASE("mistakes in modes by formulas are told at their places") {
  Json study = with_banks(tanks());
  Json& modes = study["system"]["modes"];
  modes[0]["parameters"]["l1"] = {{"lower", 0}, {"upper", 0.02}};
  modes[1]["f"] = {{"x3", "x2"}};
  modes[2]["g"] = {"x1"};
  modes.push_back({{"name", "healthy"}, {"actuator", {0}}});
  modes.push_back({{"name", "odd"}, {"f", {"x1 + q", "x2"}}});
  const Run run(study);
  CHECK(run.outcome.code == 2);
  Json faulty = with_banks(tanks());
  faulty["data"]["simulate"]["faults"] = {{{"mode", "leak_1"}, {"actuator", {1}}},
                                          {{"name", "other"}, {"from", 9}}};
  const Run faults(faulty);
  CHECK(faults.outcome.code == 2);
  const std::string told = run.outcome.out + faults.outcome.out;
  for (const char* what :
       {"/system/modes/0/parameters", "has other constant parameters with bounds",
        "/system/modes/1/f/x3", "no state is called \"x3\"", "/system/modes/2/g",
        "has 1 formula, must have 2 like /system/g", "/system/modes/3/actuator",
        "/system/modes/4/f/0", "nothing is called q", "/data/simulate/faults/0/actuator",
        "is for linear systems", "/data/simulate/faults/1", "faults of systems by formulas"}) {
    CAPTURE(std::string(what));
    CHECK(told.find(what) != std::string::npos);
  }
}
