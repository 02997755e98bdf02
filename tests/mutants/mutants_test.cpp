// SPDX-License-Identifier: GPL-3.0-or-later
// The conformance kit is tested by components that are known to be broken: each has to be caught by
// the laws that its summary names, with a witness and a command that repeats the failure.
// Components without a defect have to pass every law.
#include <algorithm>
#include <atomic>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

using nlohmann::json;

namespace {

struct Outcome {
  int code = -1;
  json report;  ///< discarded if the output was no JSON
};

/// Runs a command line of cordon, given without the program, and reads its JSON.
Outcome cordon_json(const std::string& arguments) {
  const test::Outcome outcome = test::cordon_with(arguments + " --json");
  return {outcome.code, json::parse(outcome.out, nullptr, false)};
}

/// The entry of one law in the report about one component; null if there is none.
json entry_of(const Outcome& outcome, const std::string& law) {
  if (!outcome.report.is_object() || outcome.report.value("components", json::array()).size() != 1)
    return nullptr;
  for (const json& entry : outcome.report["components"][0]["laws"]) {
    if (entry["law"] == law) return entry;
  }
  return nullptr;
}

/// One component with one law that has to catch it.
struct Trial {
  std::string plugin, kind, component, verdict, law, defect;
  Outcome found, replayed;
};

const char* const plugins[] = {CORDON_MUTANTS_DIRECTORY "/mutants.so",
                               CORDON_COMPONENT_MUTANTS_DIRECTORY "/component_mutants.so"};

/// What the plugins say about their mutants: "VERDICT LAW …: defect".
std::vector<Trial> all_trials() {
  std::vector<Trial> trials;
  const Outcome list = cordon_json("--plugins \"" CORDON_MUTANTS_DIRECTORY
                                   "\" --plugins \"" CORDON_COMPONENT_MUTANTS_DIRECTORY "\" list");
  REQUIRE(list.code == 0);
  for (const json& component : list.report.at("components")) {
    const bool of_backends = component.at("plugin") == "mutants";
    if (!of_backends && component.at("plugin") != "component_mutants") continue;
    const std::string summary = component.at("summary");
    const std::size_t colon = summary.find(": ");
    std::istringstream words(summary.substr(0, colon));
    std::string verdict, law;
    words >> verdict;
    if (verdict == "keeps") continue;
    while (words >> law)
      trials.push_back({plugins[of_backends ? 0 : 1],
                        component.at("kind"),
                        component.at("name"),
                        verdict,
                        law,
                        summary.substr(colon + 2),
                        {},
                        {}});
  }
  return trials;
}

/// Finds the failure, and repeats it by the command that the report names.
void run(Trial& trial) {
  const std::string seconds = trial.verdict == "hangs" ? " --timeout 1" : "";
  trial.found = cordon_json("conform \"" + trial.plugin + "\" --cases 300 --kind " + trial.kind +
                            " --component " + trial.component + " --law " + trial.law + seconds);
  const json entry = entry_of(trial.found, trial.law);
  const std::string replay = entry.is_object() ? entry.value("replay", "") : "",
                    program = "cordon ";
  if (replay.starts_with(program))
    trial.replayed = cordon_json(replay.substr(program.size()) + seconds);
}

void run_all(std::vector<Trial>& trials) {
  std::atomic<std::size_t> next{0};
  std::vector<std::jthread> workers;
  for (unsigned k = 0; k < std::max(2U, std::thread::hardware_concurrency()); ++k) {
    workers.emplace_back([&] {
      for (std::size_t i = next++; i < trials.size(); i = next++) run(trials[i]);
    });
  }
}

/// Laws that no plugin can break, because the framework's public functions keep them for all.
const std::set<std::string> kept_by_the_framework{
    "tightness.claims_meet",      "algebra.empty_hull",   "contract.dimension_errors",
    "contract.not_finite_errors", "observer.bad_samples", "gain.update"};

}  // namespace

TEST_CASE("backends without a defect pass every law") {
  for (const std::string backend : {"reference", "padded", "silent", "coarse"}) {
    CAPTURE(backend);
    const Outcome outcome = cordon_json(
        "conform \"" CORDON_MUTANTS_DIRECTORY "/mutants.so\" --cases 300 --component " + backend);
    CHECK(outcome.code == 0);
    REQUIRE(outcome.report.is_object());
    for (const json& entry : outcome.report.at("components").at(0).at("laws")) {
      CAPTURE(entry.dump(1));
      // all but the two that say little have something to check by every law except the one about
      // backends that round outward
      const bool skipped = entry.at("status") == "skipped";
      CHECK((skipped || entry.at("status") == "passed"));
      CHECK((!skipped || backend == "coarse" || backend == "silent" ||
             entry.at("law") == "soundness.rational"));
    }
  }
}

TEST_CASE("components of other kinds without a defect pass every law") {
  const Outcome list = cordon_json("--plugins \"" CORDON_COMPONENT_MUTANTS_DIRECTORY "\" list");
  int controls = 0;
  for (const json& component : list.report.at("components")) {
    const std::string summary = component.at("summary"), name = component.at("name");
    if (component.at("plugin") != "component_mutants" || !summary.starts_with("keeps")) continue;
    CAPTURE(name);
    ++controls;
    const Outcome outcome =
        cordon_json("conform \"" + std::string(plugins[1]) + "\" --component " + name);
    CHECK(outcome.code == 0);
    CAPTURE(outcome.report.dump(1));
    const std::string text = outcome.report.dump();
    CHECK(text.find("\"passed\"") != std::string::npos);
  }
  CHECK(controls >= 6);
}

TEST_CASE("every mutant is caught by its laws, with a witness and a replay") {
  std::vector<Trial> trials = all_trials();
  CHECK(trials.size() >= 90);
  run_all(trials);
  for (const Trial& trial : trials) {
    CAPTURE(trial.component);
    CAPTURE(trial.defect);
    CAPTURE(trial.law);
    const json entry = entry_of(trial.found, trial.law);
    if (!entry.is_object()) {
      FAIL_CHECK("no report about the law");
      continue;
    }
    CAPTURE(entry.dump(1));
    const bool violation = trial.verdict == "breaks";
    const std::string status = violation                    ? "failed"
                               : trial.verdict == "crashes" ? "crashed"
                                                            : "timed_out";
    CHECK(entry.at("status") == status);
    CHECK(trial.found.code == (violation ? 4 : 3));
    CHECK_FALSE(entry.value("witness", "").empty());
    CHECK_FALSE(entry.value("reason", "").empty());
    const json again = entry_of(trial.replayed, trial.law);
    CHECK(trial.replayed.code == trial.found.code);
    CHECK((again.is_object() && again.at("status") == status));
  }
}

TEST_CASE("laws go on after a crash") {
  const Outcome outcome = cordon_json(
      "conform \"" CORDON_MUTANTS_DIRECTORY
      "/mutants.so\" --component crashes_in_one_dimension --law 'soundness.*' --cases 9");
  CHECK(outcome.code != 0);
  REQUIRE(outcome.report.is_object());
  const json& laws = outcome.report.at("components").at(0).at("laws");
  const auto count = [&](const char* status) {
    return std::count_if(laws.begin(), laws.end(),
                         [&](const json& entry) { return entry.at("status") == status; });
  };
  CHECK(count("crashed") >= 2);
  CHECK(count("passed") >= 5);
  CHECK(entry_of(outcome, "soundness.affine_map").at("status") == "crashed");
  CHECK(entry_of(outcome, "soundness.line_form").at("status") == "passed");
}

TEST_CASE("every law has a mutant, or is kept by the framework") {
  const Outcome list = cordon_json("conform --list");
  REQUIRE(list.code == 0);
  std::set<std::string> laws, tested = kept_by_the_framework;
  for (const json& entry : list.report.at("laws")) laws.insert(entry.at("law").get<std::string>());
  for (const Trial& trial : all_trials()) {
    if (trial.verdict == "breaks") tested.insert(trial.law);
  }
  for (const std::string& law : laws) {
    CAPTURE(law);
    CHECK(tested.contains(law));
  }
  for (const std::string& law : tested) {
    CAPTURE(law);
    CHECK(laws.contains(law));
  }
}
