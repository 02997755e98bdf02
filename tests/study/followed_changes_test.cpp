// SPDX-License-Identifier: GPL-3.0-or-later
// Banks that carry on what a change of the mode leads to.
#include <cmath>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "study/study_run.hpp"

using Json = nlohmann::ordered_json;
using Run = test::StudyRun;

namespace {

Json with_followed(Json study, const char* observer,
                   std::initializer_list<const char*> backends = {"interval", "zonotope",
                                                                  "constrained_zonotope"}) {
  for (const char* backend : backends) {
    study["pipelines"].push_back({{"name", backend},
                                  {"backend", backend},
                                  {"diagnoser",
                                   {{"type", "consistency_bank"},
                                    {"observer", observer},
                                    {"waiting_time", 15},
                                    {"changes", "followed"}}}});
  }
  study["data"]["simulate"]["noise"] = "vertex";
  study["data"]["simulate"]["seeds"] = 4;
  return study;
}

/// A level with a leak of unknown size, or a sensor that shows too little. No set holds the level
/// at all times.
Json tank() {
  return Json::parse(R"json({"cordon": 1,
    "system": {"type": "nonlinear", "states": ["h"], "inputs": ["q"], "disturbances": ["w"],
      "noises": ["v"], "parameters": {"leak": {"lower": 0, "upper": 0}},
      "f": ["h + q - (0.3 + leak)*sqrt(h) + w"], "g": ["h + v"],
      "X0": {"type": "box", "lower": [3], "upper": [5]},
      "W": {"type": "box", "lower": [-0.01], "upper": [0.01]},
      "V": {"type": "box", "lower": [-0.05], "upper": [0.05]},
      "modes": [{"name": "leak", "parameters": {"leak": {"lower": 0.02, "upper": 0.06}}},
                {"name": "sensor", "g": ["0.8*h + v"]}]},
    "data": {"simulate": {"steps": 40, "seed": 3, "x0": [4, 0],
      "input": [{"type": "constant", "offset": 0.6}]}}})json");
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

}  // namespace

TEST_CASE("whenever a mode begins, following the change keeps it, and needs no set of all times") {
  int told = 0;
  for (const char* mode : {"leak", "sensor"}) {
    for (const char* start : {"any", "nominal"}) {
      for (const int from : {1, 9, 17}) {
        CAPTURE(std::string(mode));
        CAPTURE(std::string(start));
        CAPTURE(from);
        Json study = with_followed(tank(), "nonlinear");
        study["data"]["simulate"]["faults"] = {{{"mode", mode}, {"from", from}}};
        for (Json& pipeline : study["pipelines"]) pipeline["diagnoser"]["start"] = start;
        const Run run(study);
        CAPTURE(run.outcome.out);
        REQUIRE(run.outcome.code == 0);
        CHECK(count(run.outcome.out, "True mode excluded: never") == 3);
        for (std::size_t i = 0; i < 3; ++i) {
          const Json last = run.pipeline(i)["summary"]["last_state"];
          if (std::string(start) == "nominal" && i == 2) REQUIRE(last.is_object());
          if (last.is_null() || last["mode"] != mode) continue;
          ++told;
          const double leak = std::string(mode) == "leak" ? 0.04 : 0;
          CHECK(last["hull"]["lower"][1].get<double>() <= leak);
          CHECK(last["hull"]["upper"][1].get<double>() >= leak);
        }
      }
    }
  }
  CHECK(told >= 30);  // of 36
}

TEST_CASE("without such a set modes cannot begin anew where changes are not followed") {
  Json study = with_followed(tank(), "nonlinear", {"zonotope"});
  study["data"]["simulate"]["faults"] = {{{"mode", "leak"}, {"from", 17}}};
  study["pipelines"][0]["diagnoser"]["changes"] = "restart";
  const Run run(study);
  REQUIRE(run.outcome.code == 0);
  CHECK(run.pipeline(0)["summary"]["last_state"].is_null());
}

TEST_CASE("linear modes, outputs that are missing, and the observers of descriptor systems") {
  Json study = Json::parse(R"({"cordon": 1,
    "system": {"type": "lti", "A": [[0.9, 0.2], [0, 0.8]], "B": [[0], [1]],
      "Bw": [[1, 0], [0, 1]], "C": [[1, 0], [0, 1]], "Dv": [[1, 0], [0, 1]],
      "X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
      "W": {"type": "box", "lower": [-0.02, -0.02], "upper": [0.02, 0.02]},
      "V": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]},
      "modes": [{"name": "weak", "actuator": [0.4]}, {"name": "low", "sensor": [0.7, 1]}]},
    "data": {"simulate": {"steps": 40, "seed": 5, "x0": [0.5, 0.5],
      "dropouts": [{"outputs": [1, 2], "probability": 0.2}],
      "input": [{"type": "constant", "offset": 1}]}}})");
  for (const char* observer : {"prediction_correction", "descriptor"}) {
    for (const char* mode : {"weak", "low"}) {
      CAPTURE(std::string(observer));
      CAPTURE(std::string(mode));
      Json followed = with_followed(study, observer, {"constrained_zonotope", "line_zonotope"});
      followed["data"]["simulate"]["faults"] = {{{"mode", mode}, {"from", 11}}};
      const Run run(followed);
      CAPTURE(run.outcome.out);
      REQUIRE(run.outcome.code == 0);
      CHECK(count(run.outcome.out, "True mode excluded: never") == 2);
      for (std::size_t i = 0; i < 2; ++i)
        CHECK(run.pipeline(i)["summary"]["last_state"]["mode"] == mode);
    }
  }
}

TEST_CASE("a second change before the reset is told as an assumption that fails") {
  Json study = with_followed(tank(), "nonlinear");
  study["data"]["simulate"]["faults"] = Json::parse(
      R"([{"mode": "leak", "from": 10, "to": 10}, {"mode": "sensor", "from": 11, "to": 30}])");
  study["data"]["simulate"]["seeds"] = 20;
  const Run run(study);
  CAPTURE(run.outcome.out);
  CHECK(run.outcome.code == 0);
  CHECK(count(run.outcome.out, "lies outside the restart set") >= 1);
}

TEST_CASE("static rows hold for the mode of their time, so that changes are not followed") {
  Json study = Json::parse(R"({"cordon": 1,
    "system": {"type": "descriptor", "E": [[1, 0], [0, 0]], "A": [[0.5, 0], [1, -1]],
      "B": [[1], [0]], "Bw": [[1, 0], [0, 1]], "C": [[1, 0], [0, 1]],
      "X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
      "W": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]},
      "V": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]},
      "modes": [{"name": "weak", "actuator": [0.4]}]},
    "data": {"simulate": {"steps": 10, "input": [{"type": "constant", "offset": 1}]}}})");
  const Run refused(with_followed(study, "descriptor", {"line_zonotope"}));
  CHECK(refused.outcome.code == 2);
  CHECK(refused.outcome.out.find("/pipelines/0/diagnoser/changes") != std::string::npos);
  CHECK(refused.outcome.out.find("takes systems without E") != std::string::npos);
}
