// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>

#include "design_run.hpp"
#include "diagnosis_run.hpp"
#include "pipeline_guard.hpp"
#include "study/checks/assumption_check.hpp"
#include "study/checks/growth.hpp"
#include "study/checks/inner_check.hpp"
#include "study/checks/outside.hpp"
#include "study/checks/rounding_margin.hpp"
#include "study/results/median.hpp"
#include "study/results/results.hpp"
#include "time_limit.hpp"

namespace cordon {

namespace {

using detail::AssumptionCheck;
using detail::Assumptions;
using detail::barely_outside;
using detail::clearly_outside;
using detail::Clock;
using detail::InnerCheck;
using detail::is_own_model;
using detail::Median;
using detail::MetricBoard;
using detail::MetricValues;
using detail::Results;
using detail::RoundingMargin;
using detail::seconds_since;
using detail::TimeLimit;

struct Medians {
  Median predict, correct, reduce, question, hull, step;

  void add(const PhaseTimes& times, double hull_us) {
    predict.add(times.predict);
    correct.add(times.correct);
    reduce.add(times.reduce);
    question.add(times.question);
    hull.add(hull_us);
    step.add(times.step());
  }
};

constexpr Index nominal_mode = 0;  // in bank_of(study)

/// Data that come from the study's model with all its bounds, as long as there is no fault.
/// One pipeline: its components, and what became of it so far.
class Pipeline {
 public:
  Pipeline(const Study& study, const PipelineSpec& spec)
      : study_(study), own_model_(is_own_model(study)) {
    outcome_.name = spec.name;
    outcome_.backend = spec.backend.type;
    outcome_.observer = spec.observer.type;
  }

  std::optional<Rounding> rounding() const {
    return backend_ ? std::optional(backend_->info().rounding) : std::nullopt;
  }
  const std::optional<Assumptions>& assumptions() const { return assumptions_; }
  const std::vector<Gain>& gains() const { return outcome_.gains; }

  void make(const PipelineSpec& spec, const Registry& registry) {
    guarded([&] {
      backend_ = registry.make<BackendEntry>(spec.backend.type, spec.backend.params);
      observer_ = registry.make<ObserverEntry>(spec.observer.type, {study_.model, backend_},
                                               spec.observer.params);
      board_.emplace(study_.metrics, registry);
      observer_->start();
      assumptions_ = {observer_->initial_set(), std::nullopt, observer_->follows_its_sets()};
      if (const Set* admissible = observer_->admissible_set())
        assumptions_->admissible_set = admissible->line_form();
      detail::PipelineAssumptions assumed{
          .initial_set = assumptions_->initial_set,
          .exact_data = backend_->info().rounding != Rounding::nominal};
      if (assumptions_->admissible_set)
        assumed.admissible_sets.push_back(*assumptions_->admissible_set);
      check_.emplace(study_, std::move(assumed));
      rounding_.emplace(study_.model, assumptions_->initial_set, backend_->info().rounding);
      outcome_.gains = observer_->gains();
    });
  }

  /// The time is over: the pipeline has stopped with an error.
  bool gives_up(const TimeLimit& limit) {
    guarded([&] { limit.check(outcome_.steps); });
    return failed();
  }

  /// False once the pipeline has stopped with an error.
  bool step(const Record& record, Results* results) {
    std::optional<Estimate> estimate;
    Box hull;
    std::optional<Box> inner;
    const MetricValues* values = nullptr;
    double hull_us = 0;
    nominal_ = nominal_ && record.mode.value_or(nominal_mode) == nominal_mode;
    guarded([&] {
      estimate = observer_->step(record.sample);
      const Clock::time_point begin = Clock::now();
      hull = estimate->consistent == Answer::no
                 ? Box::empty(estimate->set->dim())
                 : estimate->set->interval_hull(results ? &hull_proofs_ : nullptr);
      hull_us = seconds_since(begin) * 1e6;
      inner = observer_->inner_estimate();
      if (inner) inner_.step(estimate->k, *inner, hull);
      const Vector* truth = judge(record, *estimate);
      const bool assumptions_hold = nominal_ && !check_->excuses(record.sample.k);
      values = &board_->step({*estimate, hull, truth, assumptions_hold, observer_->times()});
      if (results) results->check_columns(*values);
    });
    if (!outcome_.error.empty()) return false;
    if (outcome_.inconsistent_from < 0)
      medians_.add(observer_->times(), hull_us);  // ∅ stays ∅ without any work
    count(*estimate, hull);
    if (results)
      results->step({*estimate, hull, hull_proofs_, inner, *values, observer_->times(), hull_us});
    growth_.step(estimate->k, hull);
    outcome_.last_hull = std::move(hull);
    return true;
  }

  PipelineOutcome finish(Results* results, double wall_s) {
    MetricValues summary;
    if (board_) guarded([&] { summary = board_->summary(); });
    outcome_.summary = summary.reproducible;
    outcome_.reproducible = summary.reproducible.size();
    outcome_.summary.insert(outcome_.summary.end(), summary.measured.begin(),
                            summary.measured.end());
    outcome_.median_us = {medians_.predict.value(), medians_.correct.value(),
                          medians_.reduce.value(), medians_.question.value()};
    outcome_.median_hull_us = medians_.hull.value();
    outcome_.median_step_us = medians_.step.value();
    outcome_.largest_step_us = medians_.step.largest();
    outcome_.wall_s = wall_s;
    outcome_.growth = growth_.growth();
    if (check_) detail::tell(check_->failed(), outcome_);
    outcome_.inner_steps = inner_.steps();
    outcome_.inner_outside = inner_.outside();
    if (inner_.steps() > 0) outcome_.inner_share = inner_.share();
    if (results) results->end_pipeline(outcome_, summary);
    return std::move(outcome_);
  }

  bool failed() const { return !outcome_.error.empty(); }

 private:
  template <class Work>
  void guarded(Work&& work) {
    detail::guarded(outcome_, std::forward<Work>(work));
  }

  /// Looks at assumptions and containment; returns the truth at the estimate's time, if the data
  /// have it.
  const Vector* judge(const Record& record, const Estimate& estimate) {
    check_->step(record);
    if (!record.truth) return nullptr;
    passed_.push_back({record.sample, *record.truth});
    while (!passed_.empty() &&
           passed_.front().sample.k < estimate.k) {  // estimates may lag behind the samples
      before_ = std::move(passed_.front().sample);
      passed_.pop_front();
    }
    if (passed_.empty() || passed_.front().sample.k != estimate.k) return nullptr;
    const Vector& truth = passed_.front().truth;
    if (outcome_.outside_from < 0 && is_outside(estimate, truth)) {
      outcome_.outside_from = estimate.k;
      const Index k = record.sample.k;
      if (own_model_ && nominal_ && !check_->excuses(k) &&
          !check_->excuses_by_rounding(k, barely_outside(estimate.set->line_form(), truth)))
        outcome_.violated_at = estimate.k;
    }
    return &truth;
  }

  /// By more than rounding errors may amount to.
  bool is_outside(const Estimate& estimate, const Vector& truth) {
    if (estimate.consistent == Answer::no) return true;
    const LineForm X = estimate.set->line_form();
    const bool follows = before_ && before_->k + 1 == estimate.k;
    const Vector margin = rounding_->next(X, follows ? &*before_ : nullptr, passed_.front().sample);
    return holds(*estimate.set, truth) == Answer::no &&
           detail::outside_by_its_size(X, truth, margin);
  }

  Answer holds(const Set& X, const Vector& x) {
    const Answer answer = X.contains(x);
    outcome_.containment.add(answer != Answer::unknown);
    return answer;
  }

  void count(const Estimate& estimate, const Box& hull) {
    ++outcome_.steps;
    outcome_.emptiness.add(estimate.consistent != Answer::unknown);
    if (estimate.consistent != Answer::no) {
      const bool all = hull.is_bounded() || estimate.set->is_bounded() == Answer::no;
      for (Index i = 0; i < hull.dim(); ++i) {
        outcome_.bounds.add(all || std::isfinite(hull.upper[i]));
        outcome_.bounds.add(all || std::isfinite(hull.lower[i]));
      }
    }
    switch (estimate.consistent) {
      case Answer::yes:
        ++outcome_.consistent;
        break;
      case Answer::unknown:
        ++outcome_.undecided;
        break;
      case Answer::no:
        ++outcome_.inconsistent;
        if (outcome_.inconsistent_from < 0) outcome_.inconsistent_from = estimate.k;
        break;
    }
  }

  const Study& study_;
  bool own_model_;
  bool nominal_ = true;  ///< the plant has had no fault so far, as far as the data tell
  std::shared_ptr<const SetBackend> backend_;
  std::shared_ptr<Observer> observer_;
  std::optional<Assumptions> assumptions_;
  std::optional<AssumptionCheck> check_;
  std::optional<MetricBoard> board_;
  struct Passed {
    Sample sample;
    Vector truth;
  };
  std::deque<Passed> passed_;     ///< whose estimate is still to come, or has just come
  std::optional<Sample> before_;  ///< the sample before these
  std::optional<RoundingMargin> rounding_;
  std::vector<Certificate> hull_proofs_;
  Medians medians_;
  InnerCheck inner_;
  detail::GrowthWatch growth_;
  PipelineOutcome outcome_;
};

/// Runs one pipeline over its own stream of the data. False: stopped from outside.
bool run_pipeline(const Study& study, std::size_t index, const Registry& registry,
                  const RunOptions& options, const TimeLimit& limit, DataSource& data,
                  Results* results, RunOutcome& outcome) {
  const PipelineSpec& spec = study.pipelines[index];
  const Clock::time_point begin = Clock::now();
  const std::int64_t total = data.size().value_or(0);
  Pipeline pipeline(study, spec);
  pipeline.make(spec, registry);
  if (results)
    results->begin_pipeline(spec, pipeline.rounding(), pipeline.assumptions(), pipeline.gains());
  std::int64_t done = 0;
  Clock::time_point told = begin;
  while (!pipeline.failed()) {
    if (options.stop && options.stop->load()) return false;
    const std::optional<Record> record = data.next();
    if (!record || pipeline.gives_up(limit)) break;
    if (results) results->data(*record);
    if (!pipeline.step(*record, results)) break;
    ++done;
    if (options.progress && seconds_since(told) > 0.05) {
      options.progress(index, done, total);
      told = Clock::now();
    }
  }
  if (options.progress) options.progress(index, done, total);
  outcome.pipelines.push_back(pipeline.finish(results, seconds_since(begin)));
  return true;
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
  return simulate && !simulate->plant && !simulate->made_plant;
}

RunOutcome detail::run_on(const OpenData& open, const Study& study, const Registry& registry,
                          const RunOptions& options) {
  if (!options.pipeline.empty()) return run_one(open, study, registry, options);
  const TimeLimit limit(options.deadline);
  const bool streams = std::any_of(study.pipelines.begin(), study.pipelines.end(),
                                   [](const auto& p) { return !p.designer; });
  std::unique_ptr<DataSource> data =
      streams ? open(0) : nullptr;  // first: bad data leave no trace on the disk
  std::optional<detail::DirectoryLock> lock;
  std::optional<Results> results;
  if (!options.out.empty()) results.emplace(study, registry, lock.emplace(options.out));
  Results* const writer = results ? &*results : nullptr;
  RunOutcome outcome;
  outcome.measures = detail::measures_of(study.metrics, registry);
  for (std::size_t i = 0; i < study.pipelines.size(); ++i) {
    bool done = true;
    if (study.pipelines[i].designer || study.pipelines[i].diagnoser) {
      std::optional<PipelineOutcome> found =
          study.pipelines[i].designer
              ? detail::run_design(study, i, registry, options, limit, writer)
              : detail::run_diagnosis(open, study, i, registry, options, limit, writer);
      done = found.has_value();
      if (found) outcome.pipelines.push_back(std::move(*found));
    } else {
      if (i > 0) data = open(0);
      done = run_pipeline(study, i, registry, options, limit, *data, writer, outcome);
    }
    if (!done) {
      outcome.interrupted = true;
      return outcome;
    }
  }
  if (options.stop && options.stop->load()) {
    outcome.interrupted = true;
  } else if (writer) {
    outcome.files = writer->commit(outcome);
    results.reset();
    if (options.report) outcome.report_error = options.report(lock->directory(), outcome.files);
  }
  return outcome;
}

RunOutcome run_study(const Study& study, const Registry& registry, const RunOptions& options) {
  return detail::run_on([&](std::uint64_t seed_offset) { return open_data(study, seed_offset); },
                        study, registry, options);
}

}  // namespace cordon
