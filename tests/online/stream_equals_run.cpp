// SPDX-License-Identifier: GPL-3.0-or-later
// The data of every example study through `cordon stream`: the same sets, decisions and numbers,
// step by step, as `cordon run` has left in its results.
#include <fstream>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "run/program.hpp"

namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// What a step of the stream does not know: true values, and what metrics make of them.
Json without_truth(Json step, const Json& like) {
  Json kept = Json::object();
  for (const auto& [key, value] : step.items()) {
    if (like.contains(key)) kept[key] = value;
  }
  if (kept.contains("faults"))
    for (Json& fault : kept["faults"]) fault.erase("truth");
  return kept;
}

void compare(const std::string& study, const Json& pipeline, const std::string& directory,
             const std::vector<std::string>& sets) {
  const std::string name = pipeline["name"];
  CAPTURE(name);
  const bool estimates = pipeline.contains("observer");
  const test::Outcome outcome =
      test::cordon_with("stream '" + study + "' --pipeline '" + name + "' --quiet" +
                        (estimates ? " --sets" : "") + " < '" + directory + "/data.csv'");
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  const Json& steps = pipeline["steps"];
  std::size_t at = 0, set = 0;
  const std::string of_pipeline = "{\"pipeline\": " + Json(name).dump() + ", ";
  for (const std::string& line : lines_of(outcome.out)) {
    Json step = Json::parse(line);
    REQUIRE_MESSAGE(!step.contains("error"), line);
    if (step["k"].is_null()) continue;  // of an observer that lags
    for (const char* more : {"events", "alarms", "sample", "restarted", "not_enclosed"})
      step.erase(more);
    if (step.contains("set")) {
      while (set < sets.size() && sets[set].rfind(of_pipeline, 0) != 0) ++set;
      REQUIRE(set < sets.size());
      REQUIRE(line.find(sets[set]) != std::string::npos);
      ++set;
      step.erase("set");
    }
    REQUIRE(at < steps.size());
    const Json expected = without_truth(steps[at], step);
    REQUIRE_MESSAGE(step.dump() == expected.dump(), step["k"].dump());
    ++at;
  }
  CHECK(at == steps.size());
  CHECK(at > 0);
}

}  // namespace

TEST_CASE("streams give the steps of runs") {
  if (!std::filesystem::exists(CORDON_EXAMPLE_RUNS)) {  // a build without the room of the examples
    MESSAGE("the examples have not been run: left out");
    return;
  }
  int compared = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CORDON_EXAMPLES)) {
    if (entry.path().extension() != ".json") continue;
    const std::filesystem::path directory =
        std::filesystem::path(CORDON_EXAMPLE_RUNS) / entry.path().stem();
    if (!std::filesystem::exists(directory / "results.json")) continue;
    CAPTURE(entry.path().string());
    const Json results = Json::parse(std::ifstream(directory / "results.json"));
    if (!results.contains("pipelines")) continue;  // of a sweep
    const std::vector<std::string> sets = lines_of(bytes_of(directory / "sets.jsonl"));
    for (const Json& pipeline : results["pipelines"]) {
      if (pipeline.contains("designer") || !pipeline.contains("steps")) continue;
      if (pipeline.contains("error") && !pipeline["error"].is_null()) continue;
      compare(entry.path().string(), pipeline, directory.string(), sets);
      ++compared;
    }
  }
  MESSAGE(compared, " pipelines");
  CHECK(compared > 20);
}
