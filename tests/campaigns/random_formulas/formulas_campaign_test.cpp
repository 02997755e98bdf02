// SPDX-License-Identifier: GPL-3.0-or-later
// `cordon run` and `cordon verify` on random formulas, by every method: no truth is lost, and no
// result is refuted.
//   CORDON_CAMPAIGN_SYSTEMS   how many (30), from number
//   CORDON_CAMPAIGN_FIRST     (0) on
//   CORDON_CAMPAIGN_KEEP      a directory that keeps studies and results of those that failed
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>

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

}  // namespace

TEST_CASE("no truth of random formulas is lost, whatever the method") {
  const std::uint64_t first = asked("CORDON_CAMPAIGN_FIRST", 0),
                      count = asked("CORDON_CAMPAIGN_SYSTEMS", 30);
  const char* keep = std::getenv("CORDON_CAMPAIGN_KEEP");
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
    if (keep && !holds) {
      fs::create_directories(keep);
      fs::copy(home.path(), fs::path(keep) / std::to_string(number),
               fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    }
  }
  MESSAGE(verified, " verified, ", undecided, " with results that are not decided, ", refused,
          " refused by the program");
  CHECK(4 * refused <= count);
}
