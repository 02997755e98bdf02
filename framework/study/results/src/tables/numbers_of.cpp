// SPDX-License-Identifier: GPL-3.0-or-later
// Everything of an outcome that is a number, under its name in the tables.
#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/study/result_table.hpp"

namespace cordon {

namespace {

class Numbers {
 public:
  void add(const std::string& name, double value, bool measured = false) {
    const bool taken = std::any_of(all_.begin(), all_.end(),
                                   [&](const ResultNumber& n) { return n.column.name == name; });
    if (!taken) all_.push_back({{name, measured}, value});
  }
  void count(const std::string& name, std::int64_t number) {
    add(name, static_cast<double>(number));
  }
  /// A time index; negative: it did not happen.
  void time(const std::string& name, std::int64_t k) {
    add(name, k < 0 ? not_available : static_cast<double>(k));
  }
  void share(const std::string& name, std::int64_t part, std::int64_t of) {
    add(name, of > 0 ? static_cast<double>(part) / static_cast<double>(of) : not_available);
  }
  void measured(const std::string& name, double value) { add(name, value, true); }
  void answer(const std::string& name, Answer answer) {
    add(name,
        answer == Answer::unknown ? not_available : static_cast<double>(answer == Answer::yes));
  }
  void delay(const std::string& name, const DelayStatistics& delays) {
    const bool any = delays.count > 0;
    add(name + "_min", any ? static_cast<double>(delays.min) : not_available);
    add(name + "_median", any ? delays.median : not_available);
    add(name + "_max", any ? static_cast<double>(delays.max) : not_available);
  }

  std::vector<ResultNumber> take() { return std::move(all_); }

 private:
  std::vector<ResultNumber> all_;
};

/// The number of a metric; nothing for words.
std::optional<double> number_of(const MetricValue& metric) {
  if (const auto* value = std::get_if<double>(&metric.value)) return *value;
  if (const auto* count = std::get_if<Index>(&metric.value)) return static_cast<double>(*count);
  return std::nullopt;
}

void add_metrics(Numbers& numbers, const EstimationOutcome& outcome) {
  for (std::size_t i = 0; i < outcome.summary.size(); ++i) {
    const MetricValue& metric = outcome.summary[i];
    if (const auto number = number_of(metric))
      numbers.add(metric.name, *number, i >= outcome.reproducible);
  }
}

void add_estimation(Numbers& numbers, const PipelineOutcome& outcome) {
  const EstimationOutcome& found = *outcome.estimation();
  numbers.count("consistent", found.consistent);
  numbers.count("inconsistent", found.inconsistent);
  numbers.count("undecided", found.undecided);
  numbers.time("inconsistent_from", found.inconsistent_from);
  numbers.time("assumptions_until", outcome.assumptions_until);
  numbers.time("outside_from", found.outside_from);
  numbers.time("violated_at", outcome.violated_at);
  numbers.count("answers_decided",
                found.emptiness.decided + found.containment.decided + found.bounds.decided);
  numbers.count("answers_unknown",
                found.emptiness.unknown + found.containment.unknown + found.bounds.unknown);
  numbers.add("inner_share", found.inner_steps > 0 ? found.inner_share : not_available);
  numbers.time("inner_outside", found.inner_outside);
  add_metrics(numbers, found);
}

void add_faults(Numbers& numbers, const std::vector<FaultStatistics>& faults) {
  if (faults.empty()) return;
  std::int64_t bounds = 0, proven = 0, checked = 0, outside = 0;
  for (const FaultStatistics& fault : faults) {
    bounds += fault.bounds;
    proven += fault.excluded_0;
    checked += fault.checked;
    outside += fault.outside;
  }
  numbers.count("fault_bounds", bounds);
  numbers.count("faults_proven", proven);
  if (checked > 0) numbers.count("faults_outside", outside);
  for (const FaultStatistics& fault : faults) {
    const std::string name = "fault_" + std::to_string(fault.fault + 1);
    numbers.add(name + "_half_width", fault.bounds > 0 ? fault.mean_half_width : not_available);
    numbers.add(name + "_rms_error", fault.checked > 0 ? fault.rms_error : not_available);
  }
}

/// When such an event is told first; -1: never.
Index first_of(const std::vector<DiagnosisEvent>& events, DiagnosisEvent::Kind kind) {
  const auto found = std::find_if(events.begin(), events.end(),
                                  [&](const DiagnosisEvent& event) { return event.what == kind; });
  return found == events.end() ? -1 : found->k;
}

void add_diagnosis(Numbers& numbers, const PipelineOutcome& outcome) {
  const DiagnosisOutcome& found = *outcome.diagnosis();
  numbers.time("assumptions_until", outcome.assumptions_until);
  numbers.time("violated_at", outcome.violated_at);
  numbers.count("runs", found.runs);
  if (found.truth_known) {
    ModeStatistics bank, outside;  // counts over the modes of the bank, and outside it
    for (const ModeStatistics& counts : found.statistics) {
      ModeStatistics& sum = counts.mode < 0 ? outside : bank;
      sum.segments += counts.segments;
      sum.detected += counts.detected;
      sum.isolated += counts.isolated;
      sum.missed += counts.missed;
      sum.unknown_fault += counts.unknown_fault;
    }
    numbers.count("false_alarms", found.false_alarms);
    numbers.share("false_alarm_rate", found.runs_with_false_alarm, found.runs);
    numbers.share("wrong_mode_rate", found.runs_with_wrong_mode, found.runs);
    numbers.count("segments", bank.segments + outside.segments);
    numbers.count("detected", bank.detected + outside.detected);
    numbers.count("isolated", bank.isolated);
    numbers.count("missed", bank.missed);
    numbers.share("missed_rate", bank.missed, bank.segments);
    numbers.count("outside_the_bank", outside.segments);
    numbers.count("unknown_fault", outside.unknown_fault);
    numbers.delay("detection_delay", found.detection);
    numbers.delay("isolation_delay", found.isolation);
  } else {
    numbers.time("first_detected_at", first_of(found.events, DiagnosisEvent::Kind::detected));
    numbers.time("first_isolated_at", first_of(found.events, DiagnosisEvent::Kind::isolated));
  }
  add_faults(numbers, found.faults);
}

/// A search that proved nothing has no bound.
double bound_of(const DesignOutcome& design) {
  return design.lower_bound == -infinity ? not_available : design.lower_bound;
}

/// What is proven of the κ of every pair: 0 or less where it is not proven to be apart.
double smallest_kappa(const DesignedOutcome& outcome) {
  if (!outcome.design->best || outcome.design->best->pairs.empty()) return not_available;
  double kappa = infinity;
  for (std::size_t q = 0; q < outcome.design->best->pairs.size(); ++q) {
    const bool apart = outcome.exact && outcome.exact->pairs[q].disjoint == Answer::yes;
    kappa = std::min(kappa, apart ? outcome.exact->pairs[q].kappa_lower
                                  : std::min(0.0, outcome.design->best->pairs[q].kappa));
  }
  return kappa;
}

void add_design(Numbers& numbers, const PipelineOutcome& outcome) {
  numbers.time("assumptions_until", outcome.assumptions_until);
  numbers.time("violated_at", outcome.violated_at);
  const DesignedOutcome& found = *outcome.design();
  if (const auto& design = found.design) {
    const auto& best = design->best;
    numbers.count("horizon", design->horizon);
    numbers.add("cost", best ? best->cost : not_available);
    numbers.add("lower_bound", bound_of(*design));
    numbers.add("gap", std::isfinite(design->gap()) ? design->gap() : not_available);
    const bool searched = design->status != DesignStatus::given;
    numbers.add("optimal", searched ? static_cast<double>(design->status == DesignStatus::optimal)
                                    : not_available);
    numbers.add("infeasible", searched
                                  ? static_cast<double>(design->status == DesignStatus::infeasible)
                                  : not_available);
    numbers.answer("separates", found.exact ? found.exact->separates() : Answer::unknown);
    numbers.add("kappa_min", smallest_kappa(found));
    numbers.count("refuted_claims", static_cast<std::int64_t>(found.refuted.size()));
    numbers.count("nodes", design->nodes);
  }
  if (found.experiments.empty()) return;
  std::int64_t runs = 0, isolated = 0, wrong = 0;
  for (const ExperimentRow& row : found.experiments) {
    runs += row.runs;
    isolated += row.isolated;
    wrong += row.wrong;
  }
  numbers.count("experiments", runs);
  numbers.count("experiments_isolated", isolated);
  numbers.count("experiments_wrong", wrong);
}

}  // namespace

std::vector<ResultNumber> numbers_of(const PipelineOutcome& outcome) {
  Numbers numbers;
  const EstimationOutcome* const found = outcome.estimation();
  numbers.count("steps", outcome.steps);
  if (outcome.design()) {
    add_design(numbers, outcome);
  } else if (outcome.diagnosis()) {
    add_diagnosis(numbers, outcome);
  } else {
    add_estimation(numbers, outcome);
  }
  const StepTimes none{not_available, not_available, not_available};
  const StepTimes& step = outcome.steps > 0 ? outcome.step_us : none;
  numbers.measured("step_us", step.median);
  numbers.measured("step_99_us", step.percentile_99);
  numbers.measured("step_largest_us", step.largest);
  if (found && outcome.steps > 0) {
    numbers.measured("predict_us", found->median_us.predict);
    numbers.measured("correct_us", found->median_us.correct);
    numbers.measured("reduce_us", found->median_us.reduce);
    numbers.measured("question_us", found->median_us.question);
    numbers.measured("hull_us", found->median_hull_us);
  }
  numbers.measured("wall_s", outcome.wall_s);
  return numbers.take();
}

}  // namespace cordon
