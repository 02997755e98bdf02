// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis_report.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "cordon/interfaces/nonlinear_model.hpp"
#include "diagnosis_scores.hpp"

namespace cordon::apps {

namespace {

using Kind = DiagnosisEvent::Kind;
using Names = std::vector<std::string>;
using Rows = std::vector<std::vector<std::string>>;

constexpr std::size_t most_lines = 60;
constexpr Index nominal = 0;  // in bank_of(study)

/// How far 0 is outside, in the coordinate where it is farthest; not positive if it is inside.
double distance_to_zero(const Box& box) {
  if (box.dim() == 0 || box.is_empty()) return 0;
  return std::max(box.lower.maxCoeff(), -box.upper.minCoeff());
}

std::string evidence_text(const ModeEvidence& evidence) {
  std::string text;
  const bool by_reset = distance_to_zero(evidence.reset_residual) > 0;
  const Box& shown = by_reset ? evidence.reset_residual : evidence.residual;
  if (evidence.why.kind == Certificate::Kind::farkas ||  // not by the distance of one residual
      evidence.why.kind == Certificate::Kind::structure) {
    text = "no state explains the samples";
  } else if (const double outside = distance_to_zero(shown); outside > 0) {
    text =
        fmt::format("{} {}, 0 is {:.3g} outside",
                    by_reset ? "residual since the reset" : "residual", box_text(shown), outside);
  }
  if (evidence.why.kind != Certificate::Kind::none) {
    text += fmt::format("{}proof {}", text.empty() ? "" : ", ", to_string(evidence.why.kind));
    if (evidence.why.data.size() > 0) text += fmt::format(", margin {:.3g}", evidence.why.margin);
  }
  return text;
}

/// What makes the plant leave the bank at k, as the study calls it.
std::string outside_name(const Study& study, Index k) {
  const auto* simulate = std::get_if<SimulateSpec>(&study.data);
  if (!simulate) return "outside the bank";
  for (const FaultSpec& fault : simulate->faults) {
    if (fault.mode < 0 && fault.from <= k && k <= fault.to && !fault.name.empty())
      return fault.name + ", outside the bank";
  }
  std::set<Index> additive;
  for (const AdditiveFaultSpec& fault : simulate->additive_faults) {
    if (fault.from <= k && k <= fault.to) additive.insert(fault.fault + 1);
  }
  if (additive.empty()) return "outside the bank";
  return fmt::format("additive fault{} {}", additive.size() > 1 ? "s" : "",
                     fmt::join(additive, ", "));
}

std::string event_name(const DiagnosisEvent& event, std::optional<Index> truth_before) {
  if (event.what == Kind::truth) {
    if (event.mode == nominal) return "fault ends";
    return truth_before.value_or(nominal) == nominal ? "fault begins" : "fault changes";
  }
  return std::string(to_string(event.what));
}

/// "leak 2 [L/s] at k = 121 (605 s) in [0.0069, 0.229]", of every additive fault that is proven.
std::string proven_text(const std::vector<FaultBound>& faults, const Labels& labels) {
  std::string text;
  for (const FaultBound& bound : faults) {
    const auto i = static_cast<std::size_t>(bound.fault);
    text += fmt::format(
        "{}{} at {} in [{:.4g}, {:.4g}]", text.empty() ? "" : ", ",
        i < labels.faults.size() ? labels.faults[i] : fmt::format("additive fault {}", i + 1),
        time_text(labels, bound.at), bound.lower, bound.upper);
  }
  return text;
}

/// ", leak in [0.006, 0.014]", of the parameters that the mode knows by bounds alone, which are the
/// last states.
std::string parameters_text(const Study& study, Index mode, const Box& estimate) {
  const Index count = study.model.nonlinear ? study.model.nonlinear->parameters : 0;
  std::string text;
  if (count == 0 || estimate.dim() == 0) return text;
  const LineForm X0 = bank_of(study)[mode].model.X0;
  for (Index i = estimate.dim() - count; i < estimate.dim(); ++i) {
    if (X0.G.row(i).isZero(0)) continue;
    text += fmt::format(", {} in [{:.4g}, {:.4g}]", label_of(study.labels.states, "x", i),
                        estimate.lower[i], estimate.upper[i]);
  }
  return text;
}

/// Why something is said that has no proof of its own.
std::string reason_text(const DiagnosisEvent& event, std::size_t modes) {
  switch (event.what) {
    case Kind::truth:
      return "by the data";
    case Kind::starts:
      return event.mode < 0 ? "every mode is possible" : "assumed by the study";
    case Kind::isolated:
      return "no other mode is left";
    case Kind::resumed:
      return "nothing contradicts it any more";
    case Kind::isolating:
      return "several modes are possible";
    case Kind::ambiguous:
      return "several modes are left after the waiting time";
    case Kind::unknown_fault:
      return modes == 1 ? "the plant is outside the bank"
                        : "every mode is excluded: not yet identified, or none of these";
    case Kind::left_open:
      return "cannot be excluded any more: " + event.evidence.left_open;
    default:
      return "";
  }
}

/// One row per event; `left` counts those that are not shown.
Rows timeline(const Study& study, const DiagnosisOutcome& found, std::int64_t& left) {
  const double seconds = study.labels.sampling_time;
  Rows rows{seconds > 0 ? std::vector<std::string>{"k", "t [s]", "EVENT", "MODE", "EVIDENCE"}
                        : std::vector<std::string>{"k", "EVENT", "MODE", "EVIDENCE"}};
  std::optional<Index> truth;
  for (const DiagnosisEvent& event : found.events) {
    const std::optional<Index> before = truth;
    if (event.what == Kind::truth) {
      truth = event.mode;
      if (!before && event.mode == nominal) continue;
    }
    if (rows.size() > most_lines) {
      ++left;
      continue;
    }
    std::string mode = event.mode >= 0 ? mode_name(found.modes, event.mode) : "";
    if (event.what == Kind::starts && event.mode < 0) mode = "any";
    if (event.what == Kind::truth && event.mode < 0) mode = outside_name(study, event.k);
    if (event.what == Kind::detected) mode = "departure from " + mode;
    std::string evidence = event.faults.empty() ? evidence_text(event.evidence)
                                                : proven_text(event.faults, study.labels);
    if (evidence.empty()) evidence = reason_text(event, found.modes.size());
    if (event.mode >= 0) evidence += parameters_text(study, event.mode, event.estimate);
    rows.push_back({fmt::format("{}", event.k), event_name(event, before), mode, evidence});
    if (seconds > 0) {
      rows.back().insert(rows.back().begin() + 1,
                         fmt::format("{:.6g}", static_cast<double>(event.k) * seconds));
    }
  }
  return rows;
}

/// Like the widths of observers: as many digits as it takes to compare. What rounding makes of 0
/// is 0.
std::string number_text(double value) {
  if (std::abs(value) < 1e-300) return "0";
  if (std::isnan(value)) return "-";
  return std::isinf(value) ? "unbounded" : fmt::format("{:.6g}", value);
}

/// Bounds of the state at the end.
std::string last_state_text(const Study& study, const DiagnosisOutcome& found, const Paint& paint) {
  if (!found.last_state) return "";
  const auto& [k, mode, hull, since] = *found.last_state;
  Rows rows{{"STATE", "FROM", "TO"}};
  for (Index i = 0; i < hull.dim(); ++i) {
    rows.push_back({label_of(study.labels.states, "x", i), number_text(hull.lower[i]),
                    number_text(hull.upper[i])});
  }
  return fmt::format("\nThe state in mode \"{}\" at {}, if it has lasted since {}\n{}",
                     mode_name(found.modes, mode), time_text(study.labels, k),
                     time_text(study.labels, since), table(rows, paint));
}

/// Its name, or its number.
std::string fault_name(const Labels& labels, Index fault) {
  return labels.faults.empty() ? fmt::format("{}", fault + 1) : label_of(labels.faults, "n", fault);
}

std::string faults_text(const DiagnosisOutcome& found, const Labels& labels, const Paint& paint) {
  if (found.faults.empty()) return "";
  Rows rows{{"FAULT", "DELAY", "BOUNDS", "WITHOUT 0", "OUTSIDE", "HALF WIDTH: LAST", "MEAN",
             "RMS ERROR", "LARGEST SHARE"}};
  for (const FaultStatistics& counts : found.faults) {
    const bool any = counts.bounds > 0, checked = counts.checked > 0;
    rows.push_back({fault_name(labels, counts.fault), any ? fmt::format("{}", counts.delay) : "-",
                    fmt::format("{}", counts.bounds), fmt::format("{}", counts.excluded_0),
                    checked ? fmt::format("{} of {}", counts.outside, counts.checked) : "-",
                    any ? number_text(counts.last_half_width) : "-",
                    any ? number_text(counts.mean_half_width) : "-",
                    checked ? number_text(counts.rms_error) : "-",
                    checked ? number_text(counts.largest_share) : "-"});
  }
  std::string text =
      fmt::format("\nAdditive faults over {} (share: error of the estimate / half width)\n{}",
                  runs_text(found.runs), table(rows, paint));
  if (const auto& outside = found.fault_outside) {
    text += paint.red(fmt::format(
                "True fault outside its bounds: fault {} of {}, bounded at {} (run {} of {})",
                fault_name(labels, outside->fault), time_text(labels, outside->at),
                time_text(labels, outside->k), outside->seed_offset + 1, found.runs)) +
            "\n";
  }
  return text;
}

std::string answer_text(Answer answer) {
  return answer == Answer::unknown ? "not guaranteed" : std::string(to_string(answer));
}

std::string error_set_text(const ErrorSetCheck& check, const Names& modes) {
  std::string steady;
  if (check.mode >= 0 && check.observer >= 0) {
    steady = fmt::format(
        "; in steady state {:.4g}, attained in mode \"{}\" by the observer of \"{}\"",
        check.steady_factor, mode_name(modes, check.mode), mode_name(modes, check.observer));
  }
  if (check.computed)
    return fmt::format("Error set: computed; contains the errors by construction{}\n", steady);
  return fmt::format("Error set: given; all errors lie in {:.4g} times the set{}: {}\n",
                     check.factor, steady, check.factor <= 1 ? "large enough" : "too small");
}

std::string fault_guarantees_text(const Guarantees& guarantees, const Labels& labels,
                                  const Paint& paint) {
  if (guarantees.faults.empty()) return "";
  Rows rows{{"ADDITIVE FAULT", "DELAY", "HALF WIDTH IN STEADY STATE, BUT FOR ROUNDING"}};
  for (const FaultGuarantee& fault : guarantees.faults) {
    const std::string width = std::isinf(fault.half_width)
                                  ? "no bound is proven"
                                  : fmt::format("{:.6g}", fault.half_width);
    rows.push_back({fault_name(labels, fault.fault), fmt::format("{}", fault.delay), width});
  }
  return table(rows, paint);
}

}  // namespace

std::string box_text(const Box& box, Digits digits) {
  if (box.is_empty()) return "∅";
  std::string text;
  for (Index i = 0; i < box.dim(); ++i) {
    const double lower = box.lower[i], upper = box.upper[i],
                 largest = std::max(std::abs(lower), std::abs(upper));
    const bool fixed = digits == Digits::decimals && largest >= 0.01 && largest < 1e4;
    text += i == 0 ? "" : " × ";
    text += fixed ? fmt::format("[{:.4f}, {:.4f}]", lower, upper)
                  : fmt::format("[{:.4g}, {:.4g}]", lower, upper);
  }
  return text;
}

std::string diagnosis_text(const Study& study, const PipelineOutcome& pipeline,
                           const Paint& paint) {
  const DiagnosisOutcome& found = *pipeline.diagnosis();
  std::string text = fmt::format(
      "{}  {}, {}, {} mode{}, {:.1f} µs/step, 99 % {:.1f}, "
      "at most {:.1f}\n\n",
      paint.bold(pipeline.name), pipeline.backend, found.diagnoser, found.modes.size(),
      found.modes.size() == 1 ? "" : "s", pipeline.step_us.median, pipeline.step_us.percentile_99,
      pipeline.step_us.largest);
  std::int64_t left = 0;
  const Rows rows = timeline(study, found, left);
  if (rows.size() > 1) text += table(rows, paint);
  if (left > 0) text += fmt::format("… and {} more, in results.json\n", left);
  text += "\n";
  if (!pipeline.error.empty())
    return text + paint.red(fmt::format("Stopped: {}", pipeline.error)) + "\n";
  return text + last_state_text(study, found, paint) + score_text(study, found, paint) +
         faults_text(found, study.labels, paint) + assumption_text(study, pipeline, paint);
}

std::string assumption_text(const Study& study, const PipelineOutcome& pipeline,
                            const Paint& paint) {
  if (!pipeline.failed_assumption) return "";
  using What = FailedAssumption::What;
  const FailedAssumption& failed = *pipeline.failed_assumption;
  Names modes;
  for (const Mode& mode : bank_of(study).modes) modes.push_back(mode.name);
  const char* suggestion = "widen the set";
  if (failed.what == What::W || failed.what == What::V)
    suggestion = "widen the set, or improve the model";
  if (failed.what == What::modes) suggestion = "describe what acts there by a mode";
  if (failed.what == What::U) suggestion = "widen the set, or choose smaller inputs";
  const std::string seed =
      failed.seed_offset > 0 ? fmt::format(" (seed offset {})", failed.seed_offset) : "";
  return fmt::format("{}: {}{}. What is said from {} on rests on it and proves nothing: {}\n",
                     paint.yellow("Assumption failed"), text_of(failed, modes), seed,
                     time_text(study.labels, failed.from()), suggestion);
}

std::string diagnosis_violation(const Labels& labels, const PipelineOutcome& pipeline) {
  if (const auto& outside = pipeline.diagnosis()->fault_outside;
      outside && outside->k == pipeline.violated_at) {
    return fmt::format(
        "pipeline \"{}\" violates its guarantee: at {} the true additive fault {} of {} "
        "lies outside its bounds (seed "
        "offset {}). This is a defect of its backend or diagnoser",
        pipeline.name, time_text(labels, outside->k), fault_name(labels, outside->fault),
        time_text(labels, outside->at), outside->seed_offset);
  }
  const TrueModeExcluded& excluded = *pipeline.diagnosis()->true_mode_excluded;
  return fmt::format(
      "pipeline \"{}\" violates its guarantee: at {} it excludes the mode \"{}\", in which the "
      "plant has been since {} "
      "(seed offset {}). This is a defect of its backend or diagnoser",
      pipeline.name, time_text(labels, excluded.k),
      mode_name(pipeline.diagnosis()->modes, excluded.mode), time_text(labels, excluded.since),
      excluded.seed_offset);
}

std::string guarantees_text(const Guarantees& guarantees, const Labels& labels, const Names& modes,
                            const Paint& paint) {
  Rows rows{{"OBSERVER", "TRUE MODE", "RESIDUALS", "CONDITION", "HOLDS"}};
  for (const PairGuarantee& pair : guarantees.pairs) {
    rows.push_back({mode_name(modes, pair.observer), mode_name(modes, pair.mode),
                    fmt::format("R̊{}{} = {}", pair.mode, pair.observer,
                                box_text(pair.residual, Digits::decimals)),
                    pair.mode == pair.observer ? "0 inside" : "0 outside",
                    answer_text(pair.holds)});
  }
  std::string text = fmt::format("Method: {}\n", guarantees.method) +
                     fault_guarantees_text(guarantees, labels, paint);
  if (guarantees.pairs.empty() && !guarantees.faults.empty()) return text;
  text += table(rows, paint);
  text +=
      "R̊ij encloses all residuals of observer j once mode i has been true for long. 0 inside: the "
      "observer of the true mode\n"
      "agrees with the data; 0 outside: the data contradict that of another mode. yes and no are "
      "proven.\n";
  if (guarantees.error_set) text += error_set_text(*guarantees.error_set, modes);
  switch (guarantees.all) {
    case Answer::yes:
      return text +
             paint.green(
                 "Guaranteed in steady state: every mode is told from every other, where no "
                 "reduction enlarges the sets") +
             "\n";
    case Answer::no:
      return text +
             paint.yellow(
                 "The condition fails for some modes, whatever the accuracy: 0 lies in the limit "
                 "of "
                 "these sets, which may be larger than those of the residuals") +
             "\n";
    case Answer::unknown:
      break;
  }
  return text +
         paint.yellow(
             "Not guaranteed: some conditions are not shown to hold, which does not show that they "
             "fail") +
         "\n";
}

}  // namespace cordon::apps
