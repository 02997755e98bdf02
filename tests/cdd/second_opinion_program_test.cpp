// SPDX-License-Identifier: GPL-3.0-or-later
// `cordon verify --second-opinion` on a run of an example study: what cddlib says is counted and
// printed, and a false answer of one engine ends with code 4.
#include <filesystem>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

namespace {

using Json = nlohmann::json;
using test::Outcome;

/// A run of the example that every test reads.
std::string example_run() {
  static const Scratch home;
  static const std::string directory = (home / "run").string();
  if (!std::filesystem::exists(directory)) {
    const Outcome outcome =
        test::cordon_with("run --quiet --out " + directory +
                          " " CORDON_SOURCE_DIR "/examples/studies/linear_two_states.json");
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
  }
  return directory;
}

Outcome verify(const std::string& options, const std::string& environment = "") {
  return test::cordon_with("verify " + options + " " + example_run(), environment);
}

const std::string with_false_cddlib =
    "ASAN_OPTIONS=verify_asan_link_order=0 LD_PRELOAD=\"" CORDON_FALSE_CDDLIB "\"";

}  // namespace

TEST_CASE("the program tells how many answers cddlib has repeated") {
  const Outcome table = verify("--second-opinion");
  CAPTURE(table.out);
  CAPTURE(table.err);
  CHECK(table.code == 0);
  CHECK(table.says("cddlib 0."));
  CHECK(table.says("conversions"));
  CHECK(table.says("linear programs"));
  CHECK(table.says("Every claim that was checked holds."));

  const Outcome json = verify("--second-opinion --json");
  CHECK(json.code == 0);
  const Json report = Json::parse(json.out);
  CHECK(report["verified"] == true);
  const Json& found = report["second_opinion"];
  CHECK(found["conversions"]["agree"].get<int>() > 100);
  for (const char* questions : {"conversions", "programs"}) {
    CHECK(found[questions]["disagree"] == 0);
    CHECK(found[questions]["unanswered"] == 0);
  }
  CHECK(found["first_disagreement"] == "");
}

TEST_CASE("nobody is asked where no second opinion is wanted") {
  CHECK_FALSE(verify("").says("cddlib"));
  CHECK(Json::parse(verify("--json").out)["second_opinion"].is_null());
  CHECK(verify("", with_false_cddlib).code == 0);
}

TEST_CASE("engines that do not agree are a violation") {
  const Outcome table = verify("--second-opinion", with_false_cddlib);
  CAPTURE(table.out);
  CAPTURE(table.err);
  CHECK(table.code == 4);
  CHECK(table.complains("does not agree, pipeline \"Line zonotope\", k = 0: the conversion of "));
  CHECK_FALSE(table.says("Every claim"));

  const Outcome json = verify("--second-opinion --json", with_false_cddlib);
  CHECK(json.code == 4);
  const Json report = Json::parse(json.out);
  CHECK(report["verified"] == false);
  CHECK(report["violation"].is_null());
  CHECK(report["second_opinion"]["conversions"]["disagree"].get<int>() > 0);
  CHECK(report["second_opinion"]["first_disagreement"] != "");
}
