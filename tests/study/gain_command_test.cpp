// SPDX-License-Identifier: GPL-3.0-or-later
// What is asked of models alone needs no data: `cordon gain`, `cordon guarantees`.
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "study/study_run.hpp"

using Json = nlohmann::ordered_json;
using Run = test::StudyRun;
using test::Outcome;

namespace {

Json bank() {
  return Json::parse(R"({"cordon": 1, "title": "two modes",
    "system": {"type": "lti", "A": [[0.5, 0.1], [0, 0.8]], "C": [[1, 0], [0, 1]], "nominal": "healthy",
      "modes": [{"name": "worn", "W": {"type": "box", "lower": [0.5, -0.1], "upper": [0.7, 0.1]}}],
      "X0": {"type": "box", "lower": [-1, -1], "upper": [1, 1]},
      "W": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]},
      "V": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1]}},
    "pipelines": [
      {"name": "designed", "backend": "zonotope", "observer": {"type": "luenberger", "gain": "h_infinity"}},
      {"name": "strips", "backend": "zonotope", "observer": "prediction_correction"},
      {"name": "bank", "backend": "zonotope", "diagnoser": {"type": "observer_bank"}},
      {"name": "given", "backend": "zonotope",
       "diagnoser": {"type": "observer_bank", "gains": [[[0.5, 0], [0, 0.8]], [[0.3, 0], [0, 0.8]]]}},
      {"name": "by sets", "backend": "zonotope", "diagnoser": {"type": "consistency_bank",
       "observer": {"type": "luenberger", "gain": [[0.5, 0], [0, 0.8]]}}}]})");
}

/// Of the pipeline with that name.
Json gains_of(const Json& report, const std::string& name) {
  for (const Json& pipeline : report["pipelines"]) {
    if (pipeline["name"] == name) return pipeline["gains"];
  }
  return nullptr;
}

}  // namespace

TEST_CASE("gains are designed and certified without data, those of every mode as well") {
  const Run run(bank(), "");
  CHECK(run.outcome.code == 2);  // a run needs data
  const Outcome told = run("gain --json s.json");
  REQUIRE_MESSAGE(told.code == 0, told.out);
  const Json report = Json::parse(told.out);
  const Json designed = gains_of(report, "designed");
  REQUIRE(designed.size() == 1);
  CHECK(designed[0]["type"] == "h_infinity");
  CHECK(designed[0]["matrix"].size() == 2);
  CHECK(designed[0]["spectral_radius"].get<double>() < 1);
  CHECK(designed[0]["norm"]["upper"].get<double>() > 0);
  CHECK(gains_of(report, "strips").empty());
  for (const char* name : {"bank", "given", "by sets"}) {
    const Json gains = gains_of(report, name);
    CAPTURE(name);
    REQUIRE(gains.size() == 2);
    const std::string what = name == std::string("given") ? "gains of " : "gain of ";
    CHECK(gains[0]["name"] == what + "healthy");
    CHECK(gains[1]["name"] == what + "worn");
    for (const Json& gain : gains) CHECK(gain["spectral_radius"].get<double>() < 1);
  }
  CHECK(gains_of(report, "given")[1]["matrix"] == Json::parse("[[0.3, 0.0], [0.0, 0.8]]"));
  const Outcome text = run("gain s.json");
  CHECK(text.says("strips  works without a gain"));
  CHECK(text.says("given  gains of worn: [[0.3,0.0],[0.0,0.8]]"));
  const Outcome one = run("gain s.json --pipeline givem");
  CHECK(one.code == 2);
  CHECK(one.says("did you mean \"given\"?"));
}

TEST_CASE("the gain that is written is the gain of the run") {
  Json study = bank();
  const Run first(study, "");
  const Json matrix =
      gains_of(Json::parse(first("gain --json s.json").out), "designed")[0]["matrix"];
  study["pipelines"][0]["observer"]["gain"] = matrix;
  study["pipelines"] = Json::array({study["pipelines"][0]});
  study["data"]["simulate"]["steps"] = 3;
  const Run run(study, "");
  REQUIRE_MESSAGE(run.outcome.code == 0, run.outcome.out);
  CHECK(run.pipeline()["gains"][0]["matrix"] == matrix);
}

TEST_CASE("guarantees need neither data nor a waiting time") {
  const Run run(bank(), "");
  const Outcome told = run("guarantees --json s.json --pipeline bank");
  REQUIRE_MESSAGE(told.code == 0, told.out);
  CHECK(Json::parse(told.out)["pipelines"][0]["guarantees"]["pairs"].size() == 4);
}
