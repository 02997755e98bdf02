// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>

#include "cordon/study/session.hpp"
#include "pipeline_run.hpp"
#include "study/checks/assumption_check.hpp"
#include "study/results/quantiles.hpp"
#include "study/running/diagnosis_score.hpp"
#include "study/running/fault_score.hpp"

namespace cordon::detail {

namespace {

constexpr std::size_t most_kept = 10'000;

/// The first k at which simulated data leave the nominal model otherwise than by additive faults.
Index first_other_fault(const Study& study) {
  const auto* simulate = std::get_if<SimulateSpec>(&study.data);
  return simulate && !simulate->faults.empty() ? simulate->faults.front().from
                                               : std::numeric_limits<Index>::max();
}

/// A diagnoser with what it has found so far.
class DiagnosisRun final : public PipelineRun {
 public:
  DiagnosisRun(const RunContext& context, std::size_t index)
      : PipelineRun(context, index),
        diagnoser_spec_(spec_.diagnosis()->diagnoser),
        bank_(bank_of(context.study)),
        own_model_(is_own_model(context.study)),
        first_other_fault_(first_other_fault(context.study)),
        seeds_(seeds_of(context.study)),
        fault_score_(context.study.model.linear.faults()) {
    found_.diagnoser = diagnoser_spec_.type;
    for (const Mode& mode : bank_.modes) found_.modes.push_back(mode.name);
  }

  std::int64_t done() const override { return found_.steps; }
  std::int64_t total() const override { return total_; }

 private:
  void make() override {
    session_.emplace(context_.study, context_.registry, index_, backend());
    found_.guarantees = session_->diagnoser()->guarantees();
    found_.assumptions = session_->diagnoser()->assumptions();
    PipelineAssumptions assumed = assumptions_of(diagnoser_spec_, rounding());
    const auto* const entry = context_.registry.entry<DiagnoserEntry>(diagnoser_spec_.type);
    using Modes = PipelineAssumptions::Modes;
    assumed.modes = entry && !entry->needs_modes ? Modes::nominal_and_faults : Modes::of_the_bank;
    check_.emplace(context_.study, std::move(assumed));
  }

  void written_begin() override {
    if (context_.results) context_.results->begin_diagnosis(spec_, rounding(), found_);
  }

  /// A sample, or the end of a run.
  bool work() override {
    if (!data_) begin_run();
    const std::optional<Record> record = failed() ? std::nullopt : data_->next();
    if (record && !gives_up(found_.steps)) {
      if (Results* const results = writer()) results->data(*record);
      diagnose(*record);
      if (!failed()) return true;
    }
    end_run();
    return seed_offset_ < seeds_;
  }

  void begin_run() {
    data_ = context_.open(static_cast<std::uint64_t>(seed_offset_));
    total_ = seeds_ * data_->size().value_or(0);
    check_->begin_run(seed_offset_);
    fault_score_.begin_run(seed_offset_);
    truths_ = {};
    score_.emplace([this](const DiagnosisSegment& segment) {
      tally_.add(segment);
      if (seed_offset_ == 0) keep(found_.segments, segment);
    });
    guarded([&] { session_->start(); });
  }

  void diagnose(const Record& record) {
    DiagnosisStep step;
    std::vector<JudgedBound> faults;
    guarded([&] {
      check_->step(record);
      SessionStep taken = session_->step(record.sample);
      outcome_.left_open += taken.left_open;
      step = std::move(*taken.diagnosis);
      faults =
          fault_score_.step(record.fault, step.diagnosis, record.sample.k < first_other_fault_);
    });
    if (failed()) return;
    const Diagnosis& diagnosis = step.diagnosis;
    if (found_.steps == 0 && record.mode) found_.truth_known = true;
    score_->step(record.mode, diagnosis);
    if (diagnosis.reset) check_restart(diagnosis, record.mode);
    if (Results* const results = writer())
      results->diagnosis({diagnosis, record.mode, faults, step.step_us});
    ++found_.steps;
    step_us_.add(step.step_us);
    if (seed_offset_ > 0) return;
    ++outcome_.steps;
    truths_.step(diagnosis.k, record.mode,
                 [&](DiagnosisEvent event) { keep(found_.events, std::move(event)); });
    for (DiagnosisEvent& event : step.events) keep(found_.events, std::move(event));
    monitored_ = std::move(step.diagnosis);
  }

  /// Sets that the diagnoser tells hold the state if the mode has changed once.
  void check_restart(const Diagnosis& diagnosis, const std::optional<Index>& mode) {
    if (diagnosis.restarts.empty()) {
      check_->restarted();
    } else if (mode && *mode >= 0 && score_->changed_twice()) {
      check_->restarted_from(diagnosis.restarts.at(static_cast<std::size_t>(*mode)));
    }
  }

  static Box hull_of(const std::optional<Enclosure>& estimate) {
    return estimate && estimate->set ? (*estimate)->interval_hull() : Box{};
  }

  void end_run() {
    score_->finish();
    found_.runs += !failed();
    found_.false_alarms += score_->false_alarms();
    found_.runs_with_false_alarm += score_->false_alarms() > 0;
    found_.runs_with_wrong_mode += score_->wrong_mode();
    judge_run();
    if (seed_offset_ == 0 && monitored_ && monitored_->decision == Decision::monitoring) {
      const Box hull = hull_of(monitored_->estimate);
      if (hull.dim() > 0)
        found_.last_state = {monitored_->k, monitored_->mode, hull, monitored_->since};
    }
    if (failed() && seeds_ > 1)
      outcome_.error +=
          " (seed " + std::to_string(seed_offset_ + 1) + " of " + std::to_string(seeds_) + ")";
    data_.reset();
    ++seed_offset_;
  }

  void conclude() override {
    outcome_.step_us = step_times_of(step_us_);
    if (check_) tell(check_->failed(), outcome_);
    found_.statistics = tally_.statistics();
    found_.detection = tally_.detection();
    found_.isolation = tally_.isolation();
    found_.faults = fault_score_.statistics();
    outcome_.task = std::move(found_);
    if (context_.results) context_.results->end_diagnosis(outcome_);
  }

  /// The first seed's run is written.
  Results* writer() const { return seed_offset_ == 0 ? context_.results : nullptr; }

  /// The first exclusion of a true mode, and the first bounds without the true fault; where no
  /// failed assumption excuses one, that.
  void judge_run() {
    if (auto excluded = score_->true_mode_excluded()) {
      excluded->seed_offset = seed_offset_;
      const bool defect = blame(excluded->k, excluded->since);
      if (!found_.true_mode_excluded || (defect && exclusion_excused_)) {
        found_.true_mode_excluded = excluded;
        exclusion_excused_ = !defect;
      }
    }
    if (fault_score_.outside() && !found_.fault_outside) {
      found_.fault_outside = fault_score_.outside();
      blame(found_.fault_outside->k, 0);
    }
    if (violated_in_run_ && outcome_.violated_at < 0) outcome_.violated_at = *violated_in_run_;
    violated_in_run_.reset();
  }

  /// A statement that is proven false: a defect where the data are made by the model itself, and
  /// keep to what is assumed.
  bool blame(Index k, Index since) {
    if (!own_model_ || check_->excuses(k, since) || check_->excuses_by_rounding(k, false, since))
      return false;
    violated_in_run_ = std::min(k, violated_in_run_.value_or(k));
    return true;
  }

  template <class Item>
  void keep(std::vector<Item>& items, Item item) {
    if (items.size() < most_kept) {
      items.push_back(std::move(item));
    } else {
      ++found_.left_out;
    }
  }

  const ComponentSpec& diagnoser_spec_;
  ModeBank bank_;
  bool own_model_;
  Index first_other_fault_;
  std::optional<AssumptionCheck> check_;
  std::int64_t seeds_, seed_offset_ = 0;
  std::unique_ptr<DataSource> data_;  ///< of the run that is under way
  std::int64_t total_ = 0;
  std::optional<Session> session_;
  TruthTimeline truths_;
  std::optional<DiagnosisScore> score_;
  DiagnosisTally tally_;
  FaultScore fault_score_;
  bool exclusion_excused_ = false;  ///< that of `true_mode_excluded` is
  std::optional<Index> violated_in_run_;
  std::optional<Diagnosis> monitored_;  ///< the last one of the first seed
  Quantiles step_us_;
  DiagnosisOutcome found_;
};

}  // namespace

std::int64_t seeds_of(const Study& study) {
  const auto* simulate = std::get_if<SimulateSpec>(&study.data);
  return simulate ? std::max<std::int64_t>(1, simulate->seeds) : 1;
}

std::unique_ptr<PipelineRun> diagnosis_run(const RunContext& context, std::size_t index) {
  return std::make_unique<DiagnosisRun>(context, index);
}

}  // namespace cordon::detail
