// SPDX-License-Identifier: GPL-3.0-or-later
// `cordon verify` on banks: exclusions and states are proven again, and what is false is refuted.
#include <fstream>
#include <functional>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using test::Outcome;

constexpr int unharmed = 0, refused = 2, violated = 4, undecided = 5;

Json box(const Json& lower, const Json& upper) {
  return {{"type", "box"}, {"lower", lower}, {"upper", upper}};
}

/// Two states, of which one is seen; the first moves on its own, half as fast, or is not driven.
Json linear_study() {
  Json system = Json::parse(R"({"type": "lti", "A": [[0.9, 0.2], [0, 0.8]], "B": [[0], [1]],
    "Bw": [[1, 0], [0, 1]], "C": [[1, 0]], "Dv": [[1]]})");
  system["W"] = box({-.02, -.02}, {.02, .02});
  system["V"] = box(Json::array({-.1}), Json::array({.1}));
  Json slow = system, still = system;
  slow["A"][0][0] = .6;
  still["B"] = {{0}, {0}};
  system["X0"] = box({-1, -1}, {1, 1});
  system["modes"] = {{{"name", "slow"}, {"system", slow}}, {{"name", "still"}, {"system", still}}};
  Json study{{"cordon", 1}, {"system", system}};
  study["data"]["simulate"] = {{"steps", 40},
                               {"seed", 1},
                               {"noise", "uniform"},
                               {"x0", {.5, .5}},
                               {"input", {{{"type", "constant"}, {"offset", 1}}}},
                               {"faults", {{{"mode", "slow"}, {"from", 20}}}}};
  study["pipelines"] = {{{"name", "bank"},
                         {"backend", "constrained_zonotope"},
                         {"diagnoser",
                          {{"type", "consistency_bank"},
                           {"observer", "prediction_correction"},
                           {"waiting_time", 5},
                           {"restart_set", box({-20, -20}, {20, 20})}}}}};
  return study;
}

class BankRun {
 public:
  explicit BankRun(const Json& study) {
    std::ofstream(home_ / "study.json") << study.dump();
    const Outcome outcome =
        test::cordon_with("run --quiet --no-report --out " + (home_ / "out").string() + " " +
                          (home_ / "study.json").string());
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
  }

  Json results() const { return Json::parse(bytes_of(home_ / "out" / "results.json")); }

  Outcome verify(const std::string& options = "--json") const {
    return test::cordon_with("verify " + (home_ / "out").string() + " " + options);
  }
  Outcome verify_after(const std::function<void(Json& pipeline)>& change) const {
    Json changed = results();
    change(changed["pipelines"][0]);
    const fs::path copy = home_ / "copy";
    fs::remove_all(copy);
    fs::copy(home_ / "out", copy, fs::copy_options::recursive);
    fs::remove(copy / "manifest.json");  // which knows the file as it was
    std::ofstream(copy / "results.json") << changed.dump();
    return test::cordon_with("verify " + copy.string());
  }

 private:
  Scratch home_;
};

const BankRun& linear_run() {
  static const BankRun one(linear_study());
  return one;
}

Json found_of(const Outcome& outcome) { return Json::parse(outcome.out)["pipelines"][0]; }

std::size_t count_of(const Json& results, const std::string& what) {
  std::size_t count = 0;
  const Json events = results["pipelines"][0]["summary"]["events"];
  for (const Json& event : events) count += event["what"] == what;
  return count;
}

/// The step at which the first mode is given up.
std::size_t first_reset(const Json& pipeline) {
  for (std::size_t i = 0; i < pipeline["steps"].size(); ++i)
    if (pipeline["steps"][i]["reset"] == true) return i;
  return 0;
}

}  // namespace

TEST_CASE("exclusions of a bank and the states that it tells are proven again") {
  const Outcome outcome = linear_run().verify();
  CAPTURE(outcome.out + outcome.err);
  REQUIRE(outcome.code == unharmed);
  const Json found = found_of(outcome), results = linear_run().results();
  REQUIRE(count_of(results, "isolated") > 0);
  CHECK(found["exclusions"] == count_of(results, "excluded") + count_of(results, "detected"));
  CHECK(found["states"] == count_of(results, "isolated") + 1);  // and at the end
  CHECK(found["undecided"] == 0);
}

TEST_CASE("a mode that explains the samples is not excluded") {
  const Outcome outcome = linear_run().verify_after([](Json& pipeline) {
    const std::size_t until = first_reset(pipeline);
    REQUIRE(until > 6);
    for (std::size_t i = 5; i <= until; ++i) {  // as if the bank began anew at k = 5
      Json& step = pipeline["steps"][i];
      step["decision"] = "isolating";
      step["mode"] = nullptr;
      step["since"] = i == 5 ? 0 : 5;
      step["reset"] = i == 5;
      for (Json& mode : step["modes"]) mode = {{"candidate", true}, {"consistent", "unknown"}};
      if (i == 5) step["modes"][0]["consistent"] = "no";
    }
    for (std::size_t i = until; i < pipeline["steps"].size(); ++i) {
      pipeline["steps"][i]["since"] = 5;
      pipeline["steps"][i]["reset"] = false;
      pipeline["steps"][i]["mode"] = nullptr;
      for (Json& mode : pipeline["steps"][i]["modes"])
        mode = {{"candidate", true}, {"consistent", "unknown"}};
    }
    pipeline["summary"]["events"] = Json::array();
    pipeline["summary"]["last_state"] = nullptr;
  });
  CAPTURE(outcome.err);
  CHECK(outcome.code == violated);
  CHECK(outcome.complains("k = 5: mode \"healthy\" is excluded, and explains all samples since"));
}

TEST_CASE("decisions follow from exclusions alone") {
  const auto without_exclusion = [](Json& pipeline) {
    for (std::size_t i = 0; i < pipeline["steps"].size(); ++i)
      if (pipeline["steps"][i]["mode"] == "slow")
        for (Json& step : pipeline["steps"])
          for (Json& mode : step["modes"])
            if (step["since"] == pipeline["steps"][i]["since"]) mode["consistent"] = "unknown";
  };
  Outcome outcome = linear_run().verify_after(without_exclusion);
  CAPTURE(outcome.err);
  CHECK(outcome.code == violated);
  CHECK(outcome.complains("is no candidate, and is not excluded"));
  outcome = linear_run().verify_after([](Json& pipeline) {
    for (Json& mode : pipeline["steps"][first_reset(pipeline)]["modes"]) mode["consistent"] = "yes";
  });
  CHECK(outcome.code == violated);
  CHECK(outcome.complains("begins anew, and 1 modes are not excluded"));
  outcome = linear_run().verify_after([](Json& pipeline) {
    Json& step = pipeline["steps"][first_reset(pipeline) + 1];
    step["mode"] = "still";
  });
  CHECK(outcome.code == violated);
  CHECK(outcome.complains("mode \"still\" is isolated, and mode \"healthy\" is not excluded"));
  outcome = linear_run().verify_after(
      [](Json& pipeline) { pipeline["steps"][first_reset(pipeline) + 1]["since"] = 1; });
  CHECK(outcome.code == violated);
  CHECK(outcome.complains("speaks of the time since k = 1"));
}

TEST_CASE("the summary says what the steps do") {
  const auto changed = [](const char* what, const std::function<void(Json & event)>& change) {
    return linear_run().verify_after([&](Json& pipeline) {
      for (Json& event : pipeline["summary"]["events"]) {
        if (event["what"] != what) continue;
        change(event);
        return;
      }
    });
  };
  Outcome outcome = changed("excluded", [](Json& event) { event["mode"] = "healthy"; });
  CHECK(outcome.code == violated);
  CHECK(outcome.complains("mode \"healthy\" is not excluded by the steps"));
  outcome = changed("isolated", [](Json& event) { event["mode"] = "still"; });
  CHECK(outcome.code == violated);
  CHECK(outcome.complains("mode \"still\" is not isolated by the steps"));
  outcome = linear_run().verify_after(
      [](Json& pipeline) { pipeline["summary"]["last_state"]["mode"] = "healthy"; });
  CHECK(outcome.code == violated);
  CHECK(outcome.complains("/pipelines/0/summary/last_state/hull"));
}

TEST_CASE("a state that is told too narrowly is refuted") {
  const Outcome outcome = linear_run().verify_after([](Json& pipeline) {
    Json& hull = pipeline["summary"]["last_state"]["hull"];
    const double lower = hull["lower"][1], upper = hull["upper"][1];
    hull["upper"][1] = upper - 0.3 * (upper - lower);
  });
  CAPTURE(outcome.err);
  CHECK(outcome.code == violated);
  CHECK(outcome.complains("/pipelines/0/summary/last_state/hull"));
  CHECK(outcome.complains("coordinate 2 of the state may be from"));
}

TEST_CASE("a diagnosis that does not fit the study is refused") {
  Outcome outcome =
      linear_run().verify_after([](Json& pipeline) { pipeline["assumptions"]["modes"].erase(0); });
  CHECK(outcome.code == refused);
  CHECK(outcome.complains("has 2 modes, the study has 3"));
  outcome = linear_run().verify_after([](Json& pipeline) {
    pipeline["steps"][3]["modes"].erase(0);
    pipeline["summary"]["last_state"]["hull"]["lower"].erase(0);
  });
  CHECK(outcome.code == refused);
  CHECK(outcome.complains("/pipelines/0/steps/3"));
  CHECK(outcome.complains("is no box of the state, which has dimension 2"));
}

TEST_CASE("modes of six states that begin anywhere are excluded by rows alone") {
  Json study = linear_study();
  const auto many = [](double a) {
    Json A = Json::array();
    for (std::size_t i = 0; i < 6; ++i) {
      A.push_back(std::vector<double>(6, 0.0));
      A[i][i] = i == 0 ? a : 1.1;  // not stable
      if (i + 1 < 6) A[i][i + 1] = .3;
    }
    return A;
  };
  Json system = Json::parse(R"({"type": "lti", "C": [[1, 0, 0, 0, 0, 0], [0, 0, 0, 1, 0, 0]]})");
  system["A"] = many(.9);
  system["W"] = box(std::vector<double>(6, -.01), std::vector<double>(6, .01));
  system["V"] = box({-.05, -.05}, {.05, .05});
  Json fast = system;
  fast["A"] = many(.2);
  system["X0"] = box(std::vector<double>(6, -1), std::vector<double>(6, 1));
  system["modes"] = {{{"name", "fast"}, {"system", fast}}};
  study["system"] = system;
  Json& simulate = study["data"]["simulate"];
  simulate["x0"] = std::vector<double>(6, .5);
  simulate["faults"][0]["mode"] = "fast";
  simulate.erase("input");
  study["pipelines"][0]["backend"] = "line_zonotope";
  study["pipelines"][0]["diagnoser"].erase("restart_set");
  study["pipelines"][0]["diagnoser"].erase("start");
  const BankRun run(study);
  const Outcome outcome = run.verify();
  CAPTURE(outcome.out + outcome.err);
  CHECK(outcome.code == unharmed);
  CHECK(found_of(outcome)["exclusions"] >= 2);
  CHECK(found_of(outcome)["states"] == 3);
}

TEST_CASE("modes by formulas, parameters by bounds and samples with gaps") {
  Json study{{"cordon", 1}};
  study["system"] = Json::parse(R"({"type": "nonlinear", "states": ["h"], "inputs": ["q"],
    "disturbances": ["w"], "noises": ["v"], "parameters": {"a": 0.3, "leak": {"lower": 0, "upper": 0}},
    "f": ["h + q - (a + leak)*sqrt(h) + w"], "g": ["h + v"],
    "admissible": {"type": "box", "lower": [0.5], "upper": [20]},
    "X0": {"type": "box", "lower": [3], "upper": [5]},
    "W": {"type": "box", "lower": [-0.01], "upper": [0.01]},
    "V": {"type": "box", "lower": [-0.1], "upper": [0.1]},
    "modes": [{"name": "leak", "parameters": {"leak": {"lower": 0.02, "upper": 0.1}}},
              {"name": "pump", "f": ["h + 0.5*q - (a + leak)*sqrt(h) + w"]}]})");
  study["data"]["simulate"] = Json::parse(R"({"steps": 60, "seed": 3, "noise": "uniform",
    "x0": [4, 0], "input": [{"type": "constant", "offset": 0.6}],
    "dropouts": [{"outputs": [1], "probability": 0.3}],
    "faults": [{"mode": "leak", "from": 20, "parameters": {"leak": 0.06}}]})");
  study["pipelines"] = {
      {{"name", "bank"},
       {"backend", "zonotope"},
       {"diagnoser",
        {{"type", "consistency_bank"}, {"observer", "nonlinear"}, {"waiting_time", 30}}}}};
  study["data"]["simulate"]["faults"][0].erase("parameters");
  const BankRun run(study);
  const Outcome outcome = run.verify();
  CAPTURE(outcome.out + outcome.err);
  CHECK(outcome.code == unharmed);
  CHECK(found_of(outcome)["exclusions"] >= 3);
  const Outcome narrow = run.verify_after([](Json& pipeline) {
    Json& last = pipeline["summary"]["last_state"];
    REQUIRE(last["mode"] == "leak");
    last["hull"]["lower"][0] = last["hull"]["upper"][0];
  });
  CHECK(narrow.code == undecided);  // formulas are enclosed, which refutes nothing
  CHECK(narrow.complains("where the state is in mode \"leak\" is not proven again: coordinate 1"));
}

TEST_CASE("what tubes exclude is proven again") {
  Json linear = linear_study(), formulas{{"cordon", 1}};
  linear["data"]["simulate"]["faults"][0]["from"] = 0;
  linear["pipelines"][0]["diagnoser"] = {{"type", "tube_membership"}, {"horizon", 15}};
  formulas["system"] = Json::parse(R"({"type": "nonlinear", "states": ["h"], "inputs": ["q"],
    "disturbances": ["w"], "noises": ["v"], "parameters": {"a": 0.3},
    "f": ["h + q - a*sqrt(h) + w"], "g": ["h + v"], "X0": {"type": "box", "lower": [3], "upper": [5]},
    "W": {"type": "box", "lower": [-0.01], "upper": [0.01]},
    "V": {"type": "box", "lower": [-0.1], "upper": [0.1]},
    "modes": [{"name": "leak", "parameters": {"a": 0.36}}]})");
  formulas["data"]["simulate"] = Json::parse(R"({"steps": 15, "seed": 3, "x0": [4],
    "input": [{"type": "constant", "offset": 0.6}], "faults": [{"mode": "leak", "from": 0}]})");
  formulas["pipelines"] = Json::parse(R"([{"name": "tubes", "backend": "interval",
    "diagnoser": {"type": "tube_membership", "horizon": 15}}])");
  for (const Json& study : {linear, formulas}) {
    const BankRun run(study);
    const Outcome outcome = run.verify();
    CAPTURE(outcome.out + outcome.err);
    CHECK(outcome.code == unharmed);
    CHECK(found_of(outcome)["exclusions"] >= 1);
    const Outcome false_one = run.verify_after([](Json& pipeline) {
      for (Json& step : pipeline["steps"])
        for (Json& mode : step["modes"])
          if (mode["candidate"] == true && step["k"] == 15) {
            mode["candidate"] = false;
            mode["consistent"] = "no";
          }
    });
    CHECK(false_one.code != unharmed);
  }
}

TEST_CASE("levels that begin at empty, and parameters that a mode knows, leave nothing undecided") {
  Json study{{"cordon", 1}};
  study["system"] = Json::parse(R"({"type": "nonlinear", "states": ["h1", "h2"],
    "inputs": ["pump"], "disturbances": ["w1", "w2"], "noises": ["v1", "v2"],
    "parameters": {"power": {"lower": 1, "upper": 1}, "leak": {"lower": 0, "upper": 0}},
    "f": ["h1 + 0.5*power*pump - 0.3*sqrt(h1) + w1",
          "h2 + 0.3*sqrt(h1) - (0.28 + leak)*sqrt(h2) + w2"],
    "g": ["h1 + v1", "h2 + v2"],
    "admissible": {"type": "box", "lower": [0, 0], "upper": [12, 12]},
    "X0": {"type": "box", "lower": [2, 2], "upper": [6, 6]},
    "W": {"type": "box", "lower": [-0.01, -0.01], "upper": [0.01, 0.01]},
    "V": {"type": "box", "lower": [-0.05, -0.05], "upper": [0.05, 0.05]},
    "modes": [{"name": "weak pump", "parameters": {"power": {"lower": 0.7, "upper": 0.95}}},
              {"name": "leak", "parameters": {"leak": {"lower": 0.01, "upper": 0.04}}}]})");
  study["data"]["simulate"] = Json::parse(R"({"steps": 120, "x0": [3.5, 3.6, 1, 0],
    "input": [{"type": "square", "offset": 1.1, "amplitude": 0.15, "period": 30}],
    "dropouts": [{"probability": 0.3}],
    "faults": [{"mode": "weak pump", "from": 30, "to": 69}, {"mode": "leak", "from": 100}]})");
  study["pipelines"] = {
      {{"name", "bank"},
       {"backend", "zonotope"},
       {"diagnoser",
        {{"type", "consistency_bank"}, {"observer", "nonlinear"}, {"waiting_time", 15}}}}};
  for (int seed = 1; seed <= 8; ++seed) {
    study["data"]["simulate"]["seed"] = seed;
    const Outcome outcome = BankRun(study).verify();
    CAPTURE(seed);
    CAPTURE(outcome.out + outcome.err);
    CHECK(outcome.code == unharmed);
    CHECK(found_of(outcome)["exclusions"] == 11);
  }
}

TEST_CASE("a bank whose exclusions rest on bounds of errors is not checked") {
  Json study = linear_study();
  study["system"]["modes"].erase(1);
  study["system"]["modes"][0] = {{"name", "weak"}, {"actuator", {0.2}}};
  study["data"]["simulate"]["faults"][0]["mode"] = "weak";
  study["pipelines"][0]["diagnoser"] = {
      {"type", "observer_bank"}, {"gains", {{{.5}, {.3}}, {{.5}, {.3}}}}, {"waiting_time", 5}};
  study["pipelines"][0]["backend"] = "zonotope";
  study["system"]["U"] = box(Json::array({0}), Json::array({2}));
  const BankRun run(study);
  const Outcome outcome = run.verify("");
  CHECK(outcome.code == undecided);
  CHECK(outcome.says("not re-checked: bank"));
}
