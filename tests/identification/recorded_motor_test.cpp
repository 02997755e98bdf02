// SPDX-License-Identifier: GPL-3.0-or-later
// The study of a recorded motor: its W and V are those that `cordon identify` finds again.
#include <fstream>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "study/study_run.hpp"

using Json = nlohmann::ordered_json;
using Run = test::StudyRun;

namespace {

std::string shipped_text(const std::string& name) {
  std::ifstream in(CORDON_SOURCE_DIR "/examples/studies/" + name);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

/// As it is shipped, but for where its record is.
Json motor() {
  Json study = Json::parse(shipped_text("motor_identified.json"));
  study["data"]["csv"]["file"] = "d.csv";
  return study;
}

/// With the bounds that were guessed.
Json guessed_motor() {
  Json study = motor();
  study["system"]["W"] = Json::parse(R"({"type": "box", "lower": [-20], "upper": [20]})");
  study["system"]["V"] = Json::parse(R"({"type": "box", "lower": [-0.005], "upper": [0.005]})");
  return study;
}

}  // namespace

TEST_CASE("the bounds of the recorded motor are found again, and explain what was held out") {
  const Run run(guessed_motor(), shipped_text("motor_encoder.csv"));
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  const test::Outcome told =
      run("identify s.json --scale W --train 70% --margin 20% --write t.json");
  CAPTURE(told.out);
  REQUIRE(told.code == 0);
  for (const char* what :
       {"210 samples of 300", "They do not explain all samples", "With 20% more they do."})
    CHECK(told.out.find(what) != std::string::npos);
  const Json found = Json::parse(run.text("t.json"))["system"], there = motor()["system"];
  CHECK(found["$comment"] == there["$comment"]);
  for (const char* set : {"W", "V"}) {
    for (const char* side : {"lower", "upper"}) {
      const double again = found[set][side][0].get<double>();
      CHECK(there[set][side][0].get<double>() == doctest::Approx(again).epsilon(1e-7));
    }
  }
  const test::Outcome all = run("identify t.json --json");
  CHECK(Json::parse(all.out)["factors"]["cost"].get<double>() < 1);
}

TEST_CASE("estimates of the recorded motor hold its true angle and speed") {
  const Run run(motor(), shipped_text("motor_encoder.csv"));
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  for (std::size_t i = 0; i < 2; ++i) {
    const Json summary = run.pipeline(i)["summary"];
    CAPTURE(summary.dump());
    CHECK(summary["consistent"] == 300);
    CHECK(summary["contains_truth_yes"] == 300);
  }
  CHECK(run("verify out").code == 0);
}

TEST_CASE("a margin that is too small for the rest is told") {
  const Run run(guessed_motor(), shipped_text("motor_encoder.csv"));
  const test::Outcome told = run("identify s.json --scale W --train 70% --margin 0.001%");
  CAPTURE(told.out);
  CHECK(told.code == 0);
  CHECK(told.out.find("With 0.001% more they do not either.") != std::string::npos);
  const auto report = [&](const char* options) {
    return Json::parse(run("identify s.json --scale W --json " + std::string(options)).out);
  };
  CHECK(report("--train 70% --margin 20%")["all_samples_with_margin"]["cost"].get<double>() < 1);
  CHECK_FALSE(report("--train 70%").contains("all_samples_with_margin"));
  CHECK_FALSE(report("--margin 20%").contains("all_samples_with_margin"));
}

TEST_CASE("a margin is tried on the rest where bounds are sought with estimates, too") {
  const Run run(guessed_motor(), shipped_text("motor_encoder.csv"));
  const std::string searched =
      "identify s.json --scale W --train 5% --pipeline \"constrained zonotopes\" ";
  const test::Outcome little = run(searched + "--margin 0.01%"),
                      much = run(searched + "--margin 100%"), none = run(searched);
  CAPTURE(little.out + much.out + none.out);
  CHECK(little.out.find("With 0.01% more it does so at k = ") != std::string::npos);
  CHECK(much.out.find("With 100% more it leaves estimates, too.") != std::string::npos);
  CHECK(none.out.find("The rest of the samples contradicts it at k = ") != std::string::npos);
  CHECK(none.out.find(" more it ") == std::string::npos);
}
