// SPDX-License-Identifier: GPL-3.0-or-later
// "max_programs" of pipelines: what a step may solve, the same on every run.
#include <fstream>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "online/study.hpp"
#include "run/program.hpp"

using namespace online_test;
using Json = nlohmann::ordered_json;

namespace {

/// The study with a limit in every pipeline, and with what is merged into each diagnoser.
std::string limited_study(const Json& limit, const Json& diagnoser = Json::object()) {
  Json study = Json::parse(study_text());
  for (Json& pipeline : study["pipelines"]) {
    pipeline["max_programs"] = limit;
    if (pipeline.contains("diagnoser")) pipeline["diagnoser"].update(diagnoser);
  }
  study["data"] = {{"simulate",
                    {{"steps", 60},
                     {"input", {{{"type", "sine"}, {"amplitude", 1}, {"omega", 0.3}}}},
                     {"dropouts", {{{"probability", 0.3}}}}}}};
  return study.dump();
}

std::vector<SessionStep> steps_of(const std::string& study, const std::string& pipeline) {
  const Loaded loaded(study, Loaded::whole);
  Session session(loaded.study, loaded.registry, pipeline);
  std::vector<SessionStep> told;
  LeakyPlant plant;
  for (int k = 0; k < 60; ++k) {
    const GivenSample sample = plant.next();
    told.push_back(session.step(sample.u, sample.y));
  }
  return told;
}

std::string text_of(const std::string& study, const std::string& pipeline) {
  std::string text;
  for (const SessionStep& step : steps_of(study, pipeline))
    text += json_of(step, {"healthy", "leak"});
  return text;
}

}  // namespace

TEST_CASE("the limit is read, written, and described for editors") {
  const Loaded loaded(limited_study(7), Loaded::whole);
  CHECK(loaded.study.pipelines[1].max_programs == 7);
  CHECK(Json::parse(loaded.study.resolved)["pipelines"][1]["max_programs"] == 7);
  CHECK(!Json::parse(Loaded().study.resolved)["pipelines"][1].contains("max_programs"));
  const Json schema = Json::parse(study_json_schema(loaded.registry));
  CHECK(schema["$defs"]["pipeline"]["properties"]["max_programs"]["minimum"] == 0);
  for (const Json& wrong : {Json(-1), Json(0.5), Json("7"), Json(nullptr)})
    CHECK_THROWS_WITH_AS(Loaded(limited_study(wrong), Loaded::whole),
                         doctest::Contains("/pipelines/3/max_programs"), InputError);
}

TEST_CASE("steps within the limit are those without one, and others tell no more than these") {
  const auto free = steps_of(study_text(), "constrained");
  const auto enough = steps_of(limited_study(1'000'000), "constrained"),
             few = steps_of(limited_study(1), "constrained");
  int left_open = 0;
  for (std::size_t k = 0; k < free.size(); ++k) {
    CHECK(!free[k].left_open);
    CHECK(!enough[k].left_open);
    CHECK(json_of(free[k], {}) == json_of(enough[k], {}));
    const Box &tight = free[k].estimate->hull, &wide = few[k].estimate->hull;
    CHECK((wide.lower.array() <= tight.lower.array() + 1e-9).all());
    CHECK((wide.upper.array() >= tight.upper.array() - 1e-9).all());
    left_open += few[k].left_open;
  }
  CHECK(left_open > 20);
}

TEST_CASE("what a limit leaves open is the same with any number of threads") {
  std::vector<std::string> told;
  for (const int threads : {1, 2, 5})
    told.push_back(text_of(limited_study(1, {{"threads", threads}}), "bank"));
  CHECK(told[0] == told[1]);
  CHECK(told[0] == told[2]);
}

TEST_CASE("what a limit leaves open is the same after a restore") {
  for (const char* pipeline : {"constrained", "bank"}) {
    CAPTURE(std::string(pipeline));
    const Loaded loaded(limited_study(2), Loaded::whole);
    Session undisturbed(loaded.study, loaded.registry, pipeline);
    LeakyPlant plant;
    for (int k = 0; k < 60; ++k) {
      const GivenSample sample = plant.next(k > 40);
      Session other(loaded.study, loaded.registry, pipeline);
      other.restore(undisturbed.save());
      CHECK(json_of(other.step(sample.u, sample.y), {"healthy", "leak"}) ==
            json_of(undisturbed.step(sample.u, sample.y), {"healthy", "leak"}));
    }
  }
}

TEST_CASE("runs and streams with a limit say the same, and count what was left open") {
  const Scratch scratch;
  const auto study = scratch.write("study.json", limited_study(1));
  const auto out = (scratch.path() / "out").string();
  const test::Outcome ran = test::cordon_with("run --out " + out + " " + study.string());
  REQUIRE_MESSAGE(ran.code == 0, ran.err);
  CHECK(ran.out.find("has left questions open in") != std::string::npos);
  const Json results = Json::parse(std::ifstream(scratch / "out/results.json"));
  const Json& pipeline = results["pipelines"][1];
  CHECK(pipeline["summary"]["left_open"].get<int>() > 10);
  CHECK(!results["pipelines"][0]["summary"].contains("left_open"));  // zonotopes need no program
  const test::Outcome streamed = test::cordon_with(
      "stream " + study.string() + " --pipeline constrained < " + out + "/data.csv");
  std::istringstream lines(streamed.out);
  std::size_t at = 0, left_open = 0;
  for (std::string line; std::getline(lines, line); ++at) {
    const Json step = Json::parse(line);
    left_open += step.contains("left_open");
    CHECK(step["hull"].dump() == pipeline["steps"][at]["hull"].dump());
  }
  CHECK(at == 61);
  CHECK(left_open == pipeline["summary"]["left_open"]);
  const test::Outcome verified = test::cordon_with("verify " + out);
  CHECK_MESSAGE(verified.code == 0, verified.err);
}
