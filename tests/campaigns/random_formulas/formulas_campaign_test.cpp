// SPDX-License-Identifier: GPL-3.0-or-later
// `cordon run` and `cordon verify` on random formulas, by every method and by linear models of
// them: no truth is lost, and no result is refuted.
//   CORDON_CAMPAIGN_SYSTEMS   how many (30), from number
//   CORDON_CAMPAIGN_FIRST     (0) on
//   CORDON_CAMPAIGN_KEEP      a directory that keeps studies and results of those that failed
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "formula_study.hpp"
#include "run/program.hpp"

namespace {

namespace fs = std::filesystem;
using test::Outcome;

Outcome program(const std::string& arguments) { return test::cordon_with(arguments + " 2>&1"); }

std::uint64_t asked(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

using Json = nlohmann::ordered_json;

void keep_failed(const Scratch& home, std::uint64_t number) {
  const char* keep = std::getenv("CORDON_CAMPAIGN_KEEP");
  if (!keep) return;
  fs::create_directories(keep);
  fs::copy(home.path(), fs::path(keep) / std::to_string(number),
           fs::copy_options::recursive | fs::copy_options::overwrite_existing);
}

/// Beside noise of 1e-9 what nominal sets of linear models say is rounding.
Json with_noise(Json study) {
  Json& system = study["system"];
  for (const char* bound : {"lower", "upper"}) {
    for (std::size_t i = 0; system.contains("V") && i < system["V"][bound].size(); ++i)
      system["V"][bound][i] = bound == std::string("lower") ? -0.01 : 0.01;
  }
  return study;
}

/// The box of X0, and as much again on all sides.
Json region_of(const Json& system) {
  Json region{{"states", {{"lower", Json::array()}, {"upper", Json::array()}}}};
  const Json &lower = system["X0"]["lower"], &upper = system["X0"]["upper"];
  for (std::size_t i = 0; i < lower.size(); ++i) {
    const double low = lower[i].get<double>(), high = upper[i].get<double>();
    const double room = 0.05 * std::abs(low) + high - low;
    region["states"]["lower"].push_back(low - room);
    region["states"]["upper"].push_back(high + room);
  }
  if (system.contains("inputs")) region["inputs"] = {{"lower", {-1}}, {"upper", {1}}};
  return region;
}

}  // namespace

TEST_CASE("no truth of random formulas is lost, whatever the method") {
  const std::uint64_t first = asked("CORDON_CAMPAIGN_FIRST", 0),
                      count = asked("CORDON_CAMPAIGN_SYSTEMS", 30);
  std::uint64_t verified = 0, undecided = 0, refused = 0;
  for (std::uint64_t number = first; number < first + count; ++number) {
    CAPTURE(number);
    const Scratch home;
    const std::string study = (home / "study.json").string(), out = (home / "out").string();
    std::ofstream(study) << cordon::campaigns::formula_study(number).dump(1) << '\n';
    Outcome outcome = program("run --quiet --no-report --out " + out + " " + study);
    const int ran = outcome.code;
    bool holds = true;
    {
      CAPTURE(outcome.out);
      CHECK((ran == 0 || ran == 2));  // 2: no trajectory starts where formulas are defined
      holds = ran == 0 || ran == 2;
    }
    if (!fs::exists(home / "out" / "results.json")) {
      ++refused;
    } else {
      outcome = program("verify --directions 2 " + out);
      CAPTURE(outcome.out);
      CHECK((outcome.code == 0 || outcome.code == 5));
      holds = holds && (outcome.code == 0 || outcome.code == 5);
      verified += outcome.code == 0 ? 1 : 0;
      undecided += outcome.code == 5 ? 1 : 0;
    }
    if (!holds) keep_failed(home, number);
  }
  MESSAGE(verified, " verified, ", undecided, " with results that are not decided, ", refused,
          " refused by the program");
  CHECK(4 * refused <= count);
}

TEST_CASE("no truth of random formulas is lost by linear models that are proven in a region") {
  const std::uint64_t first = asked("CORDON_CAMPAIGN_FIRST", 0),
                      count = asked("CORDON_CAMPAIGN_SYSTEMS", 30);
  std::uint64_t made = 0, estimates = 0;
  for (std::uint64_t number = first; number < first + count; ++number) {
    CAPTURE(number);
    const Scratch home;
    const auto at = [&](const char* name) { return (home / name).string(); };
    const Json study = with_noise(cordon::campaigns::formula_study(number));
    home.write("study.json", study.dump());
    home.write("region.json", region_of(study["system"]).dump());
    const Outcome linear = program("linearise " + at("study.json") + " --region " +
                                   at("region.json") + " --write " + at("linear.json"));
    CAPTURE(linear.out);
    CHECK((linear.code == 0 || linear.code == 2));  // 2: formulas of k, or not defined everywhere
    if (linear.code != 0) continue;
    ++made;
    const Outcome run =
        program("run --quiet --no-report --out " + at("out") + " " + at("linear.json"));
    CAPTURE(run.out);
    CHECK((run.code == 0 || run.code == 2));
    if (!fs::exists(home / "out" / "results.json")) continue;
    const Json results = Json::parse(bytes_of(home / "out/results.json"));
    for (const Json& pipeline : results["pipelines"]) {
      const Json& summary = pipeline["summary"];
      estimates += summary["steps"].get<std::uint64_t>();
      bool holds = true;
      for (const char* none : {"outside_from", "failed_assumption", "inconsistent_from"}) {
        CAPTURE(none);
        CHECK(summary[none].is_null());
        holds = holds && summary[none].is_null();
      }
      if (!holds) keep_failed(home, number);
    }
  }
  MESSAGE(made, " linear models of ", count, ", ", estimates, " estimates");
  CHECK(estimates > count);
}
