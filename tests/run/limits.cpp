// SPDX-License-Identifier: GPL-3.0-or-later
// One pipeline of a study, and pipelines that are given up when their time is over.
#include <chrono>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "cordon/study/run.hpp"
#include "run/components.hpp"
#include "run/scratch.hpp"

using namespace cordon;

namespace {

using Clock = std::chrono::steady_clock;

RunOutcome run(const Study& study, const RunOptions& options) {
  Registry registry;
  registry.add(fakes::register_all);
  return run_study(study, registry, options);
}

/// A study whose diagnosers and designers have three modes.
Study study_of(PipelineSpec spec, std::int64_t steps = 20) {
  Study study = fakes::study({std::move(spec)}, steps);
  study.modes = {{"leak", study.model}, {"stuck", study.model}};
  return study;
}

/// Options whose time is over after so many milliseconds.
RunOptions until(int milliseconds) {
  RunOptions options;
  options.deadline = Clock::now() + std::chrono::milliseconds(milliseconds);
  return options;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("one pipeline alone gives what it gives beside others") {
  const Study study =
      fakes::study({fakes::pipeline("a"), fakes::diagnosis("b"), fakes::pipeline("c")});
  const Scratch scratch;
  RunOptions options;
  const RunOutcome all = run(study, options);
  std::vector<std::size_t> told;
  options.pipeline = "c";
  options.out = scratch.path();
  options.progress = [&](std::size_t pipeline, std::int64_t, std::int64_t) {
    told.push_back(pipeline);
  };
  const RunOutcome one = run(study, options);
  REQUIRE(all.pipelines.size() == 3);
  REQUIRE(one.pipelines.size() == 1);
  CHECK(one.pipelines[0].name == "c");
  CHECK(one.pipelines[0].estimation()->last_hull.upper ==
        all.pipelines[2].estimation()->last_hull.upper);
  REQUIRE_FALSE(told.empty());
  CHECK(told.back() == 2);  // its place in the study
  const auto results = nlohmann::json::parse(bytes_of(scratch / "results.json"));
  CHECK(results["pipelines"].size() == 1);
  CHECK(results["pipelines"][0]["name"] == "c");
  CHECK_FALSE(
      std::filesystem::exists(scratch / "diagnosis.csv"));  // there is no diagnoser in this run
}

TEST_CASE("a pipeline that does not exist is told, with the nearest name") {
  RunOptions options;
  options.pipeline = "alpa";
  CHECK_THROWS_WITH_AS(
      run(fakes::study({fakes::pipeline("alpha"), fakes::pipeline("beta")}), options),
      doctest::Contains("did you mean \"alpha\"?"), InputError);
}

TEST_CASE("a pipeline is given up when the time is over, before its next step") {
  const auto limited = [](PipelineSpec spec, int milliseconds, std::int64_t steps) {
    return run(study_of(std::move(spec), steps), until(milliseconds)).pipelines.at(0);
  };
  for (const PipelineOutcome& outcome : {limited(fakes::pipeline("observer"), -1, 20),
                                         limited(fakes::diagnosis("diagnoser"), -1, 20)}) {
    CHECK(outcome.error_code == Errc::time_limit);
    CHECK(contains(outcome.error, "time limit of 0 s reached after 0 steps"));
    CHECK(outcome.steps == 0);
  }
  const PipelineOutcome later = limited(fakes::pipeline("observer"), 30, 10'000'000);
  const std::string ending = " s reached after " + std::to_string(later.steps) + " steps";
  CHECK(later.error_code == Errc::time_limit);
  CHECK(later.error.starts_with("time limit of 0.0"));
  CHECK(later.error.ends_with(ending));
  CHECK(later.steps > 0);
  bool tells_milliseconds = false;  // unless the time is over before the run begins
  for (int i = 0; i < 20 && !tells_milliseconds; ++i)
    tells_milliseconds =
        contains(limited(fakes::pipeline("observer"), 4, 10'000'000).error, "time limit of 0.00");
  CHECK(tells_milliseconds);
  CHECK(later.error.size() <=
        ending.size() + std::string("time limit of 0.0299").size());  // three digits
  CHECK(later.steps < 10'000'000);
  const PipelineOutcome ended = limited(fakes::pipeline("observer"), 3'600'000, 20);
  CHECK(ended.error.empty());
  CHECK(ended.steps == 21);
}

TEST_CASE("diagnosers count the steps of all seeds, and name the seed") {
  Study study = study_of(fakes::diagnosis("diagnoser"), 1000);
  std::get<SimulateSpec>(study.data).seeds = 1'000'000;
  const PipelineOutcome outcome = run(study, until(50)).pipelines.at(0);
  CHECK(outcome.error_code == Errc::time_limit);
  REQUIRE(outcome.diagnosis());
  CHECK(contains(outcome.error,
                 "reached after " + std::to_string(outcome.diagnosis()->steps) + " steps (seed "));
}

TEST_CASE("a design ends with its time, and keeps what it has found") {
  const PipelineOutcome outcome =
      run(study_of(fakes::design("waits", "waits")), until(20)).pipelines.at(0);
  CHECK(outcome.error_code == Errc::time_limit);
  CHECK(contains(outcome.error, "time limit of 0.0"));
  CHECK(outcome.design()->design);
  const PipelineOutcome found = run(study_of(fakes::design("found")), until(-1)).pipelines.at(0);
  CHECK(found.error.empty());  // it never asked
}

TEST_CASE("experiments with a design end with the time") {
  const PipelineOutcome outcome =
      run(study_of(fakes::design("found", "found", "truth")), until(-1)).pipelines.at(0);
  CHECK(outcome.error_code == Errc::time_limit);
  CHECK(contains(outcome.error, "(experiment with mode"));
}

TEST_CASE("stopped from outside is not out of time") {
  const std::atomic<bool> stop = true;
  for (const PipelineSpec& spec : {fakes::pipeline("observer"), fakes::diagnosis("diagnoser"),
                                   fakes::design("waits", "waits")}) {
    RunOptions options = until(-1);
    options.stop = &stop;
    const RunOutcome outcome = run(study_of(spec), options);
    CHECK(outcome.interrupted);
    CHECK(outcome.pipelines.empty());
  }
}
