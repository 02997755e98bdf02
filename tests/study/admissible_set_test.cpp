// SPDX-License-Identifier: GPL-3.0-or-later
// Levels that are never negative: every observer cuts its estimates by an admissible set, keeps the
// truth, and `cordon verify` knows of it.
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

using Json = nlohmann::ordered_json;
using test::Outcome;

namespace {

/// Two levels that run empty, of which the second one is measured badly.
Json tanks(double largest) {
  Json study = Json::parse(R"({"cordon": 1, "title": "levels", "system": {"type": "lti",
    "A": [[0.9, 0], [0.1, 0.8]], "B": [[1], [0]], "C": [[1, 0], [0.5, 1]],
    "X0": {"type": "box", "lower": [0, 0], "upper": [2, 2]},
    "W": {"type": "box", "lower": [-0.01, -0.01], "upper": [0.01, 0.01]},
    "V": {"type": "box", "lower": [-1, -1], "upper": [1, 1]}},
    "data": {"simulate": {"steps": 60, "noise": "uniform", "x0": [1.5, 1], "input":
      [{"type": "table", "values": [0.1]}]}}, "pipelines": [], "metrics": ["contains_truth"]})");
  const Json gain = Json::parse("[[0.05, 0], [0, 0.05]]");
  const Json set = {{"type", "box"}, {"lower", {0, 0}}, {"upper", {largest, largest}}};
  for (const char* backend : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    for (const char* observer : {"prediction_correction", "gain_correction", "luenberger",
                                 "zonotope_uncertain", "interval_trajectory", "integrated"}) {
      Json spec = {{"type", observer}, {"admissible_set", set}};
      if (std::string(observer) != "prediction_correction") spec["gain"] = gain;
      study["pipelines"].push_back({{"name", std::string(backend) + " " + observer},
                                    {"backend", backend},
                                    {"observer", spec}});
    }
  }
  return study;
}

}  // namespace

TEST_CASE("estimates are cut by what is known of the state at all times") {
  const Scratch scratch;
  const std::string study = scratch.write("s.json", tanks(3).dump()).string(),
                    out = (scratch.path() / "out").string();
  const Outcome ran =
      test::cordon_with("run --quiet --no-report --out " + out + " " + study + " 2>&1");
  CAPTURE(ran.out);
  REQUIRE(ran.code == 0);
  const Json results = Json::parse(bytes_of(out + "/results.json"));
  for (const Json& pipeline : results["pipelines"]) {
    CAPTURE(pipeline["name"].get<std::string>());
    double least = 0;
    for (const Json& step : pipeline["steps"]) {
      for (const Json& lower : step["hull"]["lower"]) least = std::min(least, lower.get<double>());
    }
    const bool exact = pipeline["name"].get<std::string>().find("zonotope ") != 0;
    CHECK(least >= (exact ? -1e-9 : -1));
  }
  const Outcome verified = test::cordon_with("verify --directions 2 " + out + " 2>&1");
  CAPTURE(verified.out);
  CHECK(verified.code == 0);
}

TEST_CASE("a state outside the admissible set is a failed assumption") {
  const Scratch scratch;
  const std::string study = scratch.write("s.json", tanks(1).dump()).string(),
                    out = (scratch.path() / "out").string();
  const Outcome ran = test::cordon_with("run --no-report --out " + out + " " + study + " 2>&1");
  CAPTURE(ran.out);
  CHECK(ran.code != 4);
  CHECK(ran.says("admissible set"));
}

TEST_CASE("a state that lies outside by rounding alone proves nothing empty") {
  for (const double level : {-5.55e-17, -1e-12, -1e-9}) {
    CAPTURE(level);
    Json study = tanks(3);
    study["system"]["X0"] = {{"type", "box"}, {"lower", {level, 1}}, {"upper", {level, 1}}};
    study["system"]["W"] = {{"type", "box"}, {"lower", {0, 0}}, {"upper", {0, 0}}};
    study["data"]["simulate"]["x0"] = {level, 1};
    study["data"]["simulate"]["steps"] = 3;
    const Scratch scratch;
    const std::string file = scratch.write("s.json", study.dump()).string(),
                      out = (scratch.path() / "out").string();
    const Outcome ran =
        test::cordon_with("run --quiet --no-report --out " + out + " " + file + " 2>&1");
    CAPTURE(ran.out);
    CHECK(ran.code == 0);
    const Json results = Json::parse(bytes_of(out + "/results.json"));
    for (const Json& pipeline : results["pipelines"]) {
      CAPTURE(pipeline["name"].get<std::string>());
      for (const Json& step : pipeline["steps"]) CHECK(step["consistent"] != "no");
    }
  }
}
