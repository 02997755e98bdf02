// SPDX-License-Identifier: GPL-3.0-or-later
// A pipeline at work.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "cordon/study/run.hpp"
#include "pipeline_guard.hpp"
#include "study/results/results.hpp"
#include "study/running/run_on.hpp"
#include "time_limit.hpp"

namespace cordon::detail {

/// What pipelines run on.
struct RunContext {
  const Study& study;
  const Registry& registry;
  const RunOptions& options;
  const TimeLimit& limit;
  OpenData open;
  Results* results;  ///< null: nothing is written

  bool stopped() const { return options.stop && options.stop->load(); }
};

/// `begin`, then `step` while it returns true, then `finish`; between steps a run can be left. An
/// exception of a component ends its pipeline with an error, which `finish` tells.
class PipelineRun {
 public:
  PipelineRun(const RunContext& context, std::size_t index)
      : context_(context), index_(index), spec_(context.study.pipelines[index]) {
    outcome_.name = spec_.name;
    outcome_.backend = spec_.backend.type;
  }
  virtual ~PipelineRun() = default;

  /// Makes the components.
  void begin() {
    guarded([&] {
      backend_ = context_.registry.make<BackendEntry>(spec_.backend.type, spec_.backend.params);
      make();
    });
    written_begin();
  }
  /// The next piece of work: a sample, a search, an experiment. False: nothing is left to do, or
  /// the pipeline has ended with an error.
  bool step() { return !failed() && work() && !failed(); }
  PipelineOutcome finish(double wall_s) {
    outcome_.wall_s = wall_s;
    conclude();
    return std::move(outcome_);
  }

  /// Pieces of work done, and in all (0: unknown).
  virtual std::int64_t done() const = 0;
  virtual std::int64_t total() const = 0;

 protected:
  virtual void make() = 0;
  /// Results hold the pipeline's head from here on.
  virtual void written_begin() {}
  virtual bool work() = 0;
  /// The rest of the outcome, to results too.
  virtual void conclude() = 0;

  template <class Work>
  void guarded(Work&& work) {
    detail::guarded(outcome_, std::forward<Work>(work));
  }
  bool failed() const { return !outcome_.error.empty(); }
  /// The time is over: the pipeline has ended with an error.
  bool gives_up(std::int64_t steps) {
    guarded([&] { context_.limit.check(steps); });
    return failed();
  }
  const std::shared_ptr<const SetBackend>& backend() const { return backend_; }
  std::optional<Rounding> rounding() const {
    return backend_ ? std::optional(backend_->info().rounding) : std::nullopt;
  }

  const RunContext& context_;
  std::size_t index_;
  const PipelineSpec& spec_;
  PipelineOutcome outcome_;

 private:
  std::shared_ptr<const SetBackend> backend_;
};

std::unique_ptr<PipelineRun> estimation_run(const RunContext& context, std::size_t index);
/// Over all seeds of the study, the first of which is written.
std::unique_ptr<PipelineRun> diagnosis_run(const RunContext& context, std::size_t index);
/// Designs the input, and lets the diagnoser, if there is one, find out every mode of the bank from
/// experiments with it, over all seeds of the study. A design that the limit ends is kept, with the
/// error.
std::unique_ptr<PipelineRun> design_run(const RunContext& context, std::size_t index);

/// How many seeds diagnosers are tried on.
std::int64_t seeds_of(const Study& study);

}  // namespace cordon::detail
