// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis_run.hpp"

#include <chrono>
#include <limits>

#include "pipeline_guard.hpp"
#include "study/checks/assumption_check.hpp"
#include "study/results/median.hpp"
#include "study/running/diagnosis_score.hpp"
#include "study/running/fault_score.hpp"

namespace cordon::detail {

namespace {

constexpr std::size_t most_kept = 10'000;

/// Simulated by a linear model, so that a proven exclusion of the true mode is a defect.
/// The first k at which simulated data leave the nominal model otherwise than by additive faults.
Index first_other_fault(const Study& study) {
  const auto* simulate = std::get_if<SimulateSpec>(&study.data);
  return simulate && !simulate->faults.empty() ? simulate->faults.front().from
                                               : std::numeric_limits<Index>::max();
}

/// A diagnoser with what it has found so far.
class DiagnosisPipeline {
 public:
  DiagnosisPipeline(const Study& study, const PipelineSpec& spec)
      : study_(study),
        bank_(bank_of(study)),
        own_model_(is_own_model(study)),
        first_other_fault_(first_other_fault(study)),
        seeds_(seeds_of(study)),
        fault_score_(study.model.linear.faults()) {
    outcome_.name = spec.name;
    outcome_.backend = spec.backend.type;
    outcome_.diagnoser = spec.diagnoser->type;
    for (const Mode& mode : bank_.modes) found_.modes.push_back(mode.name);
  }

  void make(const PipelineSpec& spec, const Registry& registry) {
    guarded(outcome_, [&] {
      backend_ = registry.make<BackendEntry>(spec.backend.type, spec.backend.params);
      diagnoser_ = registry.make<DiagnoserEntry>(spec.diagnoser->type, {bank_, backend_},
                                                 spec.diagnoser->params);
      found_.guarantees = diagnoser_->guarantees();
      PipelineAssumptions assumed = assumptions_of(*spec.diagnoser, rounding());
      const DiagnoserEntry* const entry = registry.entry<DiagnoserEntry>(spec.diagnoser->type);
      using Modes = PipelineAssumptions::Modes;
      assumed.modes = entry && !entry->needs_modes ? Modes::nominal_and_faults : Modes::of_the_bank;
      check_.emplace(study_, std::move(assumed));
    });
  }

  std::optional<Rounding> rounding() const {
    return backend_ ? std::optional(backend_->info().rounding) : std::nullopt;
  }
  const DiagnosisOutcome& found() const { return found_; }
  bool failed() const { return !outcome_.error.empty(); }

  /// The time is over: the pipeline has stopped with an error.
  bool gives_up(const TimeLimit& limit) {
    guarded(outcome_, [&] { limit.check(found_.steps); });
    return failed();
  }

  void begin_run(std::int64_t seed_offset) {
    seed_offset_ = seed_offset;
    check_->begin_run(seed_offset);
    fault_score_.begin_run(seed_offset);
    timeline_.emplace();
    score_.emplace([this](const DiagnosisSegment& segment) {
      tally_.add(segment);
      if (seed_offset_ == 0) keep(found_.segments, segment);
    });
    guarded(outcome_, [&] { diagnoser_->start(); });
  }

  void step(const Record& record, Results* results) {
    std::optional<Diagnosis> diagnosis;
    std::vector<JudgedBound> faults;
    guarded(outcome_, [&] {
      check_->step(record);
      diagnosis = diagnoser_->step(record.sample);
      check_fits(*diagnosis, bank_, outcome_.diagnoser);
      faults = fault_score_.step(record.fault, *diagnosis, record.sample.k < first_other_fault_);
    });
    if (failed()) return;
    if (found_.steps == 0 && record.mode) found_.truth_known = true;
    if (diagnosis->reset) check_->restarted();
    ++found_.steps;
    if (seed_offset_ == 0) {
      ++outcome_.steps;
      timeline_->step(record.mode, *diagnosis,
                      [&](DiagnosisEvent event) { keep(found_.events, std::move(event)); });
    }
    median_.add(diagnoser_->step_us());
    score_->step(record.mode, *diagnosis);
    if (results) results->diagnosis({*diagnosis, record.mode, faults, diagnoser_->step_us()});
  }

  void end_run() {
    score_->finish();
    found_.runs += !failed();
    found_.false_alarms += score_->false_alarms();
    found_.runs_with_false_alarm += score_->false_alarms() > 0;
    found_.runs_with_wrong_mode += score_->wrong_mode();
    judge_run();
    if (failed() && seeds_ > 1)
      outcome_.error +=
          " (seed " + std::to_string(seed_offset_ + 1) + " of " + std::to_string(seeds_) + ")";
  }

  PipelineOutcome finish(double wall_s) {
    outcome_.median_step_us = median_.value();
    outcome_.largest_step_us = median_.largest();
    outcome_.wall_s = wall_s;
    if (check_) tell(check_->failed(), outcome_);
    found_.statistics = tally_.statistics();
    found_.detection = tally_.detection();
    found_.isolation = tally_.isolation();
    found_.faults = fault_score_.statistics();
    outcome_.diagnosis = std::move(found_);
    return std::move(outcome_);
  }

 private:
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
    if (!own_model_ || check_->excuses(k, since) || check_->excuses_by_rounding(k)) return false;
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

  const Study& study_;
  ModeBank bank_;
  bool own_model_;
  Index first_other_fault_;
  std::optional<AssumptionCheck> check_;
  std::int64_t seeds_, seed_offset_ = 0;
  std::shared_ptr<const SetBackend> backend_;
  std::shared_ptr<Diagnoser> diagnoser_;
  std::optional<DiagnosisTimeline> timeline_;
  std::optional<DiagnosisScore> score_;
  DiagnosisTally tally_;
  FaultScore fault_score_;
  bool exclusion_excused_ = false;  ///< that of `true_mode_excluded` is
  std::optional<Index> violated_in_run_;
  Median median_;
  DiagnosisOutcome found_;
  PipelineOutcome outcome_;
};

}  // namespace

std::int64_t seeds_of(const Study& study) {
  const auto* simulate = std::get_if<SimulateSpec>(&study.data);
  return simulate ? std::max<std::int64_t>(1, simulate->seeds) : 1;
}

void check_fits(const Diagnosis& diagnosis, const ModeBank& bank, const std::string& diagnoser) {
  const bool mode_fits = diagnosis.decision == Decision::monitoring
                             ? diagnosis.mode >= 0 && diagnosis.mode < bank.size()
                             : diagnosis.mode == -1;
  if (static_cast<Index>(diagnosis.modes.size()) == bank.size() && mode_fits) return;
  throw Error(Errc::plugin, "the diagnoser \"" + diagnoser +
                                "\" gave a diagnosis that does not fit its bank at k = " +
                                std::to_string(diagnosis.k));
}

std::optional<PipelineOutcome> run_diagnosis(const OpenData& open, const Study& study,
                                             std::size_t index, const Registry& registry,
                                             const RunOptions& options, const TimeLimit& limit,
                                             Results* results) {
  const PipelineSpec& spec = study.pipelines[index];
  const Clock::time_point begin = Clock::now();
  DiagnosisPipeline pipeline(study, spec);
  pipeline.make(spec, registry);
  if (results) results->begin_diagnosis(spec, pipeline.rounding(), pipeline.found());
  const std::int64_t seeds = seeds_of(study);
  std::int64_t total = 0;
  Clock::time_point told = begin;
  for (std::int64_t offset = 0; offset < seeds && !pipeline.failed(); ++offset) {
    const std::unique_ptr<DataSource> data = open(static_cast<std::uint64_t>(offset));
    total = seeds * data->size().value_or(0);
    Results* const writer = offset == 0 ? results : nullptr;
    pipeline.begin_run(offset);
    while (!pipeline.failed()) {
      if (options.stop && options.stop->load()) return std::nullopt;
      const std::optional<Record> record = data->next();
      if (!record || pipeline.gives_up(limit)) break;
      if (writer) writer->data(*record);
      pipeline.step(*record, writer);
      if (options.progress && seconds_since(told) > 0.05) {
        options.progress(index, pipeline.found().steps, total);
        told = Clock::now();
      }
    }
    pipeline.end_run();
  }
  if (options.progress) options.progress(index, pipeline.found().steps, total);
  PipelineOutcome outcome = pipeline.finish(seconds_since(begin));
  if (results) results->end_diagnosis(outcome);
  return outcome;
}

}  // namespace cordon::detail
