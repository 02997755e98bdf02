// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/run.hpp"

#include <algorithm>
#include <chrono>

#include "pipeline_run.hpp"

namespace cordon {

namespace {

using detail::Clock;
using detail::PipelineRun;
using detail::Results;
using detail::RunContext;
using detail::seconds_since;

std::unique_ptr<PipelineRun> pipeline_run(const RunContext& context, std::size_t index) {
  const PipelineSpec& spec = context.study.pipelines[index];
  if (spec.design()) return detail::design_run(context, index);
  if (spec.diagnosis()) return detail::diagnosis_run(context, index);
  return detail::estimation_run(context, index);
}

/// Nothing: stopped from outside.
std::optional<PipelineOutcome> outcome_of(const RunContext& context, std::size_t index) {
  const auto& tell = context.options.progress;
  const Clock::time_point begin = Clock::now();
  Clock::time_point told = begin;
  const std::unique_ptr<PipelineRun> run = pipeline_run(context, index);
  run->begin();
  for (bool more = true; more && !context.stopped();) {
    more = run->step();
    if (tell && seconds_since(told) > 0.05) {
      tell(index, run->done(), run->total());
      told = Clock::now();
    }
  }
  if (context.stopped()) return std::nullopt;
  if (tell) tell(index, run->done(), run->total());
  return run->finish(seconds_since(begin));
}

/// Where the pipeline of this name stands. Throws InputError if there is none.
std::size_t index_of(const Study& study, const std::string& name) {
  std::vector<std::string> names;
  for (const PipelineSpec& spec : study.pipelines) names.push_back(spec.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  throw InputError(study.file.string(),
                   {{"/pipelines", "there is no pipeline \"" + name + "\"", suggest(name, names)}});
}

/// run_on for one of the pipelines.
RunOutcome run_one(const detail::OpenData& open, Study study, const Registry& registry,
                   RunOptions options) {
  const std::size_t index = index_of(study, options.pipeline);
  study.pipelines = {study.pipelines[index]};
  options.pipeline.clear();
  if (options.progress) {
    options.progress = [index, tell = options.progress](std::size_t, std::int64_t done,
                                                        std::int64_t total) {
      tell(index, done, total);
    };
  }
  return detail::run_on(open, study, registry, options);
}

}  // namespace

bool detail::is_own_model(const Study& study) {
  const auto* simulate = std::get_if<SimulateSpec>(&study.data);
  return simulate && !simulate->plant && !simulate->made_plant && !simulate->formulas;
}

RunOutcome detail::run_on(const OpenData& open, const Study& study, const Registry& registry,
                          const RunOptions& options) {
  if (!options.pipeline.empty()) return run_one(open, study, registry, options);
  const TimeLimit limit(options.deadline);
  const bool streams = std::any_of(study.pipelines.begin(), study.pipelines.end(),
                                   [](const PipelineSpec& spec) { return !spec.design(); });
  // Opened first, for the first pipeline that asks: bad data leave no trace on the disk.
  std::unique_ptr<DataSource> opened = streams ? open(0) : nullptr;
  const OpenData next = [&](std::uint64_t seed_offset) {
    return opened && seed_offset == 0 ? std::move(opened) : open(seed_offset);
  };
  std::optional<DirectoryLock> lock;
  std::optional<Results> results;
  if (!options.out.empty()) results.emplace(study, registry, lock.emplace(options.out), options);
  const RunContext context{study, registry, options, limit, next, results ? &*results : nullptr};
  RunOutcome outcome;
  outcome.measures = measures_of(study.metrics, registry);
  for (std::size_t i = 0; i < study.pipelines.size() && !outcome.interrupted; ++i) {
    std::optional<PipelineOutcome> one = outcome_of(context, i);
    outcome.interrupted = !one;
    if (one) outcome.pipelines.push_back(std::move(*one));
  }
  outcome.interrupted = outcome.interrupted || context.stopped();
  if (outcome.interrupted || !results) return outcome;
  outcome.files = results->commit(outcome);
  results.reset();
  if (options.report) outcome.report_error = options.report(lock->directory(), outcome.files);
  return outcome;
}

RunOutcome run_study(const Study& study, const Registry& registry, const RunOptions& options) {
  return detail::run_on([&](std::uint64_t seed_offset) { return open_data(study, seed_offset); },
                        study, registry, options);
}

}  // namespace cordon
