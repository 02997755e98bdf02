// SPDX-License-Identifier: GPL-3.0-or-later
// The study of a stirred tank under control whose jacket fouls.
#include <fstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "study/study_run.hpp"

using Json = nlohmann::ordered_json;
using Run = test::StudyRun;

namespace {

Json fouled_jacket() {
  std::ifstream in(CORDON_SOURCE_DIR "/examples/studies/stirred_tank_fouled_jacket.json");
  return Json::parse(in);
}

/// What a run tells of the mode that is true from k = 60 on.
Json row_of(const Json& pipeline, const std::string& mode) {
  for (const Json& row : pipeline["summary"]["scores"]["modes"])
    if (row["mode"] == mode) return row;
  return {};
}

bool encloses(const Json& box, std::size_t i, double size) {
  return box["lower"][i].get<double>() <= size && size <= box["upper"][i].get<double>();
}

}  // namespace

TEST_CASE("a fouled jacket that the controller hides is isolated, and its factor enclosed") {
  const Run run(fouled_jacket());
  CAPTURE(run.outcome.out);
  REQUIRE(run.outcome.code == 0);
  for (std::size_t i = 0; i < 2; ++i) {
    const Json pipeline = run.pipeline(i);
    const Json summary = pipeline["summary"], row = row_of(pipeline, "fouled jacket");
    CAPTURE(row.dump());
    CHECK(summary["runs"] == 20);
    CHECK(summary["scores"]["false_alarms"] == 0);
    CHECK(summary["scores"]["runs_with_wrong_mode"] == 0);
    CHECK(summary["scores"]["true_mode_excluded"].is_null());
    CHECK(row["isolated"] == 20);
    CHECK(row["isolation_delay"]["max"] <= 6);
    for (const Json& event : summary["events"])
      if (event["what"] == "isolated") CHECK(encloses(event["estimate"], 2, 0.7));
    const Json& last = summary["last_state"];
    REQUIRE(last["mode"] == "fouled jacket");
    CHECK(encloses(last["hull"], 2, 0.7));
    CHECK(last["hull"]["upper"][2].get<double>() - last["hull"]["lower"][2].get<double>() < 0.05);
  }
  const test::Outcome verified = run("verify out");
  CAPTURE(verified.out);
  CHECK(verified.code == 0);
  for (const char* pipeline : {"constrained zonotopes", "zonotopes"})
    CHECK(verified.out.find("4 exclusions of modes and 2 boxes of the state of " +
                            std::string(pipeline) + " are proven again") != std::string::npos);
}

TEST_CASE("bounds of the jacket's factor without the true one are not proven") {
  const Run run(fouled_jacket());
  REQUIRE(run.outcome.code == 0);
  const Json hull = run.pipeline(0)["summary"]["last_state"]["hull"];
  for (const char* side : {"lower", "upper"}) {
    CAPTURE(std::string(side));
    const Run changed(fouled_jacket());
    changed.exchange(hull[side][2].dump(), side == std::string("lower") ? "0.7001" : "0.6999");
    const test::Outcome verified = changed("verify out");
    CAPTURE(verified.out);
    CHECK(verified.code == 5);
    CHECK(verified.out.find("where the state is in mode \"fouled jacket\" is not proven again") !=
          std::string::npos);
  }
}

TEST_CASE("neither the other faults of the stirred tank nor the worst noise exclude the truth") {
  for (const char* mode : {"healthy", "fouled jacket", "weak catalyst", "thermometer high"}) {
    CAPTURE(std::string(mode));
    Json study = fouled_jacket();
    study["data"]["simulate"]["noise"] = "vertex";
    study["data"]["simulate"]["faults"][0]["mode"] = mode;
    if (mode == std::string("healthy")) study["data"]["simulate"].erase("faults");
    const Run run(study);
    CAPTURE(run.outcome.out);
    REQUIRE(run.outcome.code == 0);
    for (std::size_t i = 0; i < 2; ++i) {
      const Json scores = run.pipeline(i)["summary"]["scores"];
      CHECK(scores["false_alarms"] == 0);
      CHECK(scores["runs_with_wrong_mode"] == 0);
      CHECK(scores["true_mode_excluded"].is_null());
    }
  }
}

TEST_CASE("without the controller the stirred tank leaves its admissible set") {
  Json study = fouled_jacket();
  study["system"]["parameters"]["K"] = 0;
  study["data"]["simulate"].erase("faults");
  const Run run(study);
  CAPTURE(run.outcome.out);
  CHECK(run.outcome.code == 0);
  CHECK(run.outcome.out.find("False alarms: 11 in 11 of 20 runs") != std::string::npos);
  for (std::size_t i = 0; i < 2; ++i)
    CHECK(run.pipeline(i)["summary"]["failed_assumption"]["what"] == "admissible_set");
}
