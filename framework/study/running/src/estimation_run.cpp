// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <deque>

#include "cordon/core/tolerances.hpp"
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
        observer_spec_(spec_.estimation()->observer),
        own_model_(is_own_model(context.study)),
        data_(context.open(0)),
        total_(data_->size().value_or(0)) {
    found_.observer = observer_spec_.type;
  }

  std::int64_t done() const override { return samples_; }
  std::int64_t total() const override { return total_; }

 private:
  void make() override {
    observer_ = context_.registry.make<ObserverEntry>(
        observer_spec_.type, {context_.study.model, backend()}, observer_spec_.params);
    board_.emplace(context_.study.metrics, context_.registry);
    const EstimationSpec& spec = *spec_.estimation();
    observer_->leave_out_outliers(spec.outliers, spec.outlier_window);
    observer_->start();
    assumptions_ = {observer_->initial_set(), std::nullopt, observer_->follows_its_sets()};
    assumptions_->admissible_set = observer_->admissible_set();
    assumptions_->lag = found_.lag = observer_->lag();
    PipelineAssumptions assumed{.initial_set = assumptions_->initial_set,
                                .exact_data = rounding() != Rounding::nominal};
    if (restarts()) assumptions_->restart_set = spec.restart_set;
    if (assumptions_->admissible_set)
      assumed.admissible_sets.push_back({*assumptions_->admissible_set, 0});
    check_.emplace(context_.study, std::move(assumed));
    rounding_.emplace(context_.study.model, assumptions_->initial_set, *rounding());
    found_.gains = observer_->gains();
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

  /// From now on nothing is known of what was before but that the state is in the set.
  void begin_anew(Index k, const LineForm& set) {
    since_ = k;
    observer_->start(backend()->import(set));
    rounding_.emplace(context_.study.model, set, *rounding());
    before_.reset();
    passed_.clear();
    growth_ = {};
  }

  Estimate step(const Sample& sample, bool anew) {
    if (anew) {
      begin_anew(sample.k, spec_.estimation()->restart_set);
      ++found_.restarts;
    }
    try {
      return observer_->step(sample);
    } catch (const Error& error) {
      const bool goes_on = spec_.estimation()->on_not_enclosed == OnNotEnclosed::restart;
      if (error.code() != Errc::not_enclosed || !goes_on) throw;
      if (found_.not_enclosed++ == 0) {
        found_.not_enclosed_from = sample.k;
        found_.why_not_enclosed = error.what();
      }
    }
    begin_anew(sample.k, assumptions_->admissible_set.value());
    return observer_->step(sample);
  }

  /// What was left out of the sample, or contradicts what was known.
  void tell_contradiction(const Record& record) {
    const std::optional<Contradiction>& contradiction = observer_->contradiction();
    if (!contradiction) return;
    if (observer_->left_out().empty()) {
      if (found_.inconsistent_from < 0) found_.contradiction = contradiction;
      return;
    }
    ++found_.outliers;
    if (found_.left_out.size() < most_left_out)
      found_.left_out.push_back({*contradiction, observer_->left_out()});
    seen_ = record;
    seen_->sample = missing_outputs(std::move(seen_->sample), observer_->left_out());
  }

  void estimate(const Record& given) {
    Results* const results = context_.results;
    std::optional<Estimate> estimate;
    Box hull;
    std::optional<Box> inner;
    const MetricValues* values = nullptr;
    double hull_us = 0;
    bool is_told = false;
    nominal_ = nominal_ && given.mode.value_or(nominal_mode) == nominal_mode;
    const bool anew = restarts() && was_empty_;
    seen_.reset();
    guarded([&] {
      estimate = step(given.sample, anew);
      tell_contradiction(given);
      const Record& record = seen_ ? *seen_ : given;
      was_empty_ = estimate->consistent == Answer::no;
      take(record, anew);
      is_told = is_last_of_its_time(*estimate, record.sample.k);
      if (!is_told) return;
      told_ = estimate->k;
      const Clock::time_point begin = Clock::now();
      hull = estimate->consistent == Answer::no
                 ? Box::empty(estimate->set->dim())
                 : estimate->set->interval_hull(results ? &hull_proofs_ : nullptr);
      hull_us = seconds_since(begin) * 1e6;
      inner = observer_->inner_estimate();
      if (inner) inner_.step(estimate->k, *inner, hull);
      const Vector* truth = judge(record.sample.k, *estimate);
      const bool assumptions_hold = nominal_ && !check_->excuses(record.sample.k, since_);
      values = &board_->step({*estimate, hull, truth, assumptions_hold, observer_->times()});
      if (results) results->check_columns(*values);
    });
    if (failed() || !is_told) return;
    if (found_.inconsistent_from < 0 || (restarts() && !was_empty_))
      phases_.add(observer_->times(), hull_us);  // ∅ stays ∅ without any work
    count(*estimate, hull);
    if (results)
      results->estimate({*estimate, hull, hull_proofs_, inner, *values, observer_->times(), hull_us,
                         found_.lag > 0 ? nothing_left_out_ : observer_->left_out()});
    growth_.step(estimate->k, hull);
    found_.last_hull = std::move(hull);
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

  /// Of observers that lag, several samples give an estimate of their first time, the last of which
  /// is told of. One that is proven empty already is told of at once.
  bool is_last_of_its_time(const Estimate& estimate, Index k) const {
    const bool is_last = k - estimate.k >= found_.lag || estimate.consistent == Answer::no;
    return is_last && estimate.k > told_;
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

  const ComponentSpec& observer_spec_;
  bool own_model_;
  Index since_ = 0;  ///< the observer has begun anew
  Index told_ = -1;  ///< time of the last estimate that was told of
  std::int64_t samples_ = 0;
  bool was_empty_ = false;      ///< the last estimate
  std::optional<Record> seen_;  ///< the record without what was left out
  bool nominal_ = true;         ///< the plant has had no fault so far, as far as the data tell
  std::unique_ptr<DataSource> data_;
  std::int64_t total_;
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
