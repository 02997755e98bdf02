// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <deque>

#include "cordon/core/tolerances.hpp"
#include "cordon/study/session.hpp"
#include "host_checks.hpp"
#include "pipeline_run.hpp"
#include "study/checks/assumption_check.hpp"
#include "study/checks/growth.hpp"
#include "study/checks/inner_check.hpp"
#include "study/checks/outside.hpp"
#include "study/checks/rounding_margin.hpp"
#include "study/results/quantiles.hpp"

namespace cordon::detail {

namespace {

struct Phases {
  Quantiles predict, correct, reduce, question, hull, step;

  void add(const PhaseTimes& times, double hull_us) {
    predict.add(times.predict);
    correct.add(times.correct);
    reduce.add(times.reduce);
    question.add(times.question);
    hull.add(hull_us);
    step.add(times.step());
  }
};

constexpr Index nominal_mode = 0;              // in bank_of(study)
constexpr std::size_t most_left_out = 10'000;  // in results

Vector reach_of(const LineForm& X) { return X.c.cwiseAbs() + X.G.cwiseAbs().rowwise().sum(); }

/// An observer over its own stream of the data, and what became of it so far.
class EstimationRun final : public PipelineRun {
 public:
  EstimationRun(const RunContext& context, std::size_t index)
      : PipelineRun(context, index),
        own_model_(is_own_model(context.study)),
        data_(context.open(0)),
        total_(data_->size().value_or(0)) {
    found_.observer = spec_.estimation()->observer.type;
  }

  std::int64_t done() const override { return samples_; }
  std::int64_t total() const override { return total_; }

 private:
  void make() override {
    session_.emplace(context_.study, context_.registry, index_, backend());
    session_->prove_hulls(context_.results != nullptr);
    const Observer& observer = *session_->observer();
    const EstimationSpec& spec = *spec_.estimation();
    assumptions_ = {observer.initial_set(), std::nullopt, observer.follows_its_sets()};
    assumptions_->admissible_set = observer.admissible_set();
    assumptions_->lag = found_.lag = observer.lag();
    PipelineAssumptions assumed{.initial_set = assumptions_->initial_set,
                                .exact_data = rounding() != Rounding::nominal};
    if (restarts()) assumptions_->restart_set = spec.restart_set;
    if (assumptions_->admissible_set)
      assumed.admissible_sets.push_back({*assumptions_->admissible_set, 0});
    board_.emplace(context_.study.metrics, context_.registry);
    check_.emplace(context_.study, std::move(assumed));
    rounding_.emplace(context_.study.model, assumptions_->initial_set, *rounding());
    found_.gains = observer.gains();
  }

  void written_begin() override {
    if (context_.results)
      context_.results->begin_estimation(spec_, rounding(), assumptions_, found_.gains, total_);
  }

  bool work() override {
    const std::optional<Record> record = data_->next();
    if (!record || gives_up(outcome_.steps)) return false;
    if (context_.results) context_.results->data(*record);
    estimate(*record);
    ++samples_;
    return true;
  }

  bool restarts() const { return spec_.estimation()->on_empty == OnEmpty::restart; }

  /// The observer has begun anew: of what was before nothing is known but that the state is in the
  /// set.
  void begun_anew(Index k, const LineForm& set) {
    since_ = k;
    rounding_.emplace(context_.study.model, set, *rounding());
    before_.reset();
    passed_.clear();
    growth_ = {};
  }

  void count_beginnings(Index k, const EstimateStep& step) {
    if (step.restarted) {
      begun_anew(k, spec_.estimation()->restart_set);
      ++found_.restarts;
    }
    if (step.not_enclosed.empty()) return;
    begun_anew(k, assumptions_->admissible_set.value());
    if (found_.not_enclosed++ > 0) return;
    found_.not_enclosed_from = k;
    found_.why_not_enclosed = step.not_enclosed;
  }

  /// What was left out of the sample, or contradicts what was known.
  void tell_contradiction(const Record& record, const EstimateStep& step) {
    if (!step.contradiction) return;
    if (step.left_out.empty()) {
      if (found_.inconsistent_from < 0) found_.contradiction = step.contradiction;
      return;
    }
    ++found_.outliers;
    if (found_.left_out.size() < most_left_out)
      found_.left_out.push_back({*step.contradiction, step.left_out});
    seen_ = record;
    seen_->sample = missing_outputs(std::move(seen_->sample), step.left_out);
  }

  void estimate(const Record& given) {
    Results* const results = context_.results;
    EstimateStep step;
    const MetricValues* values = nullptr;
    nominal_ = nominal_ && given.mode.value_or(nominal_mode) == nominal_mode;
    seen_.reset();
    guarded([&] {
      SessionStep taken = session_->step(given.sample);
      outcome_.left_open += taken.left_open;
      step = std::move(*taken.estimate);
      count_beginnings(given.sample.k, step);
      tell_contradiction(given, step);
      const Record& record = seen_ ? *seen_ : given;
      is_empty_ = step.estimate.consistent == Answer::no;
      take(record, step.restarted);
      if (!step.is_last) return;
      if (step.inner) inner_.step(step.estimate.k, *step.inner, step.hull);
      const Vector* truth = judge(record.sample.k, step.estimate);
      const bool assumptions_hold = nominal_ && !check_->excuses(record.sample.k, since_);
      values = &board_->step({step.estimate, step.hull, truth, assumptions_hold, step.times});
      if (results) results->check_columns(*values);
    });
    if (failed() || !step.is_last) return;
    if (found_.inconsistent_from < 0 || (restarts() && !is_empty_))
      phases_.add(step.times, step.hull_us);  // ∅ stays ∅ without any work
    count(step.estimate, step.hull);
    if (results)
      results->estimate({step.estimate, step.hull, step.hull_proofs, step.inner, *values,
                         step.times, step.hull_us,
                         found_.lag > 0 ? nothing_left_out_ : step.left_out});
    growth_.step(step.estimate.k, step.hull);
    found_.last_hull = std::move(step.hull);
  }

  void conclude() override {
    MetricValues summary;
    if (board_) guarded([&] { summary = board_->summary(); });
    found_.summary = summary.reproducible;
    found_.reproducible = summary.reproducible.size();
    found_.summary.insert(found_.summary.end(), summary.measured.begin(), summary.measured.end());
    found_.median_us = {phases_.predict.median(), phases_.correct.median(), phases_.reduce.median(),
                        phases_.question.median()};
    found_.median_hull_us = phases_.hull.median();
    outcome_.step_us = step_times_of(phases_.step);
    found_.growth = growth_.growth();
    if (check_) tell(check_->failed(), outcome_);
    found_.inner_steps = inner_.steps();
    found_.inner_outside = inner_.outside();
    if (inner_.steps() > 0) found_.inner_share = inner_.share();
    outcome_.task = std::move(found_);
    if (context_.results) context_.results->end_estimation(outcome_, summary);
  }

  /// Looks at the assumptions, and keeps the truth until its estimate comes.
  void take(const Record& record, bool anew) {
    check_->step(record);
    if (anew) check_->begun_anew_from(spec_.estimation()->restart_set);
    if (record.truth) passed_.push_back({record.sample, *record.truth});
  }

  /// Looks at containment; returns the truth at the estimate's time, if the data have it. `k`: of
  /// the sample.
  const Vector* judge(Index k, const Estimate& estimate) {
    while (!passed_.empty() &&
           passed_.front().sample.k < estimate.k) {  // estimates lag behind the samples
      before_ = std::move(passed_.front().sample);
      passed_.pop_front();
    }
    if (passed_.empty() || passed_.front().sample.k != estimate.k) return nullptr;
    const Vector& truth = passed_.front().truth;
    if (found_.outside_from < 0 && is_outside(estimate, truth)) {
      found_.outside_from = estimate.k;
      found_.outside_proven = estimate.consistent == Answer::no
                                  ? is_proven_empty(estimate)
                                  : is_proven_outside(*estimate.set, truth);
      if (own_model_ && nominal_ && !check_->excuses(k, since_) &&
          !check_->excuses_by_rounding(k, barely_outside(estimate.set->line_form(), truth), since_))
        outcome_.violated_at = estimate.k;
    }
    return &truth;
  }

  /// By more than rounding errors may amount to.
  bool is_outside(const Estimate& estimate, const Vector& truth) {
    if (estimate.consistent == Answer::no) return true;
    const LineForm X = estimate.set->line_form();
    const bool follows = before_ && before_->k + 1 == estimate.k;
    Vector margin = rounding_->next(X, follows ? &*before_ : nullptr, passed_.front().sample);
    if (found_.lag > 0)  // of later samples, which narrow it too, the margin knows nothing
      margin = margin.cwiseMax(tolerances::reported * reach_of(X));
    return holds(*estimate.set, truth) == Answer::no && outside_by_its_size(X, truth, margin);
  }

  Answer holds(const Set& X, const Vector& x) {
    const Answer answer = X.contains(x);
    found_.containment.add(answer != Answer::unknown);
    return answer;
  }

  void count(const Estimate& estimate, const Box& hull) {
    ++outcome_.steps;
    found_.emptiness.add(estimate.consistent != Answer::unknown);
    if (estimate.consistent != Answer::no) {
      const bool all = hull.is_bounded() || estimate.set->is_bounded() == Answer::no;
      for (Index i = 0; i < hull.dim(); ++i) {
        found_.bounds.add(all || std::isfinite(hull.upper[i]));
        found_.bounds.add(all || std::isfinite(hull.lower[i]));
      }
    }
    switch (estimate.consistent) {
      case Answer::yes:
        ++found_.consistent;
        break;
      case Answer::unknown:
        ++found_.undecided;
        break;
      case Answer::no:
        ++found_.inconsistent;
        if (found_.inconsistent_from < 0) {
          found_.inconsistent_from = estimate.k;
          found_.inconsistent_proven = is_proven_empty(estimate);
        }
        break;
    }
  }

  bool own_model_;
  Index since_ = 0;  ///< the observer has begun anew
  std::int64_t samples_ = 0;
  bool is_empty_ = false;       ///< the estimate
  std::optional<Record> seen_;  ///< the record without what was left out
  bool nominal_ = true;         ///< the plant has had no fault so far, as far as the data tell
  std::unique_ptr<DataSource> data_;
  std::int64_t total_;
  std::optional<Session> session_;
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
  const std::vector<Index> nothing_left_out_ = {};
  Phases phases_;
  InnerCheck inner_;
  GrowthWatch growth_;
  EstimationOutcome found_;
};

}  // namespace

std::unique_ptr<PipelineRun> estimation_run(const RunContext& context, std::size_t index) {
  return std::make_unique<EstimationRun>(context, index);
}

}  // namespace cordon::detail
