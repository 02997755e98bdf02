// SPDX-License-Identifier: GPL-3.0-or-later
// What became of the pipelines of a run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/study/design.hpp"
#include "cordon/study/pipeline_task.hpp"

namespace cordon {

/// How many questions of a kind a run has asked, by what became of them.
struct AnswerCount {
  std::int64_t decided = 0, unknown = 0;
  void add(bool is_decided) { ++(is_decided ? decided : unknown); }
};

/// Something that changed at time k: in the plant, or in what a diagnoser says of it.
struct DiagnosisEvent {
  enum class Kind {
    truth,          ///< the plant is in `mode` from k on (-1: outside the bank)
    starts,         ///< the first decision; `mode` if it is `monitoring`
    detected,       ///< `mode` was monitored, and is excluded
    excluded,       ///< so is `mode`
    isolated,       ///< `mode` is monitored from now on: all others are excluded
    resumed,        ///< `mode`, the only one of the bank, is monitored again: it is not excluded
    isolating,      ///< several modes are possible again
    ambiguous,      ///< several are left after the waiting time
    unknown_fault,  ///< none is
    left_open       ///< `mode` is not excluded by what follows, until a reset
  };
  Index k = 0;
  Kind what = Kind::truth;
  Index mode = -1;                      ///< index in the bank
  ModeEvidence evidence;                ///< detected, excluded, left_open: of that mode at k
  std::vector<FaultBound> faults = {};  ///< detected: bounds of additive faults without 0
  Box estimate = {};  ///< isolated, resumed: of the state in `mode`; dimension 0: not estimated
};
std::string_view to_string(DiagnosisEvent::Kind kind) noexcept;

/// A stretch of time with one true mode, and what the diagnoser made of it. Times are -1 where
/// nothing of the kind happened. A segment in a mode of the bank without `isolated_at` is missed,
/// whether it ends with another mode or with the data.
struct DiagnosisSegment {
  Index mode = -1;  ///< the true mode; -1: outside the bank
  Index from = 0, to = 0;
  bool scored = true;  ///< false: the first one, if the diagnoser starts by monitoring a mode
  Index detected_at =
      -1;  ///< first k at which the mode that was monitored before `from` is given up
  Index isolated_at = -1;       ///< first k at which the true mode is monitored
  Index unknown_fault_at = -1;  ///< first k with `unknown_fault`
  Index wrong_at = -1;  ///< first k, from `detected_at` on, at which another mode is monitored
  Decision last = Decision::isolating;  ///< the decision at `to`

  bool missed() const { return mode >= 0 && isolated_at < 0; }
};

/// How long something took, in steps, over all segments where it happened.
struct DelayStatistics {
  std::int64_t count = 0, min = 0, max = 0;
  double median = 0;  ///< the mean of the two in the middle, if their number is even
};

/// All scored segments of one true mode, over all seeds.
struct ModeStatistics {
  Index mode = -1;  ///< -1: outside the bank
  std::int64_t segments = 0, detected = 0, isolated = 0, missed = 0, wrong = 0, unknown_fault = 0;
  DelayStatistics detection, isolation;  ///< from the beginning of the segment; outside the bank
                                         ///< `isolation` is to unknown_fault
};

/// An exclusion that the truth contradicts: the plant has been in `mode` throughout from `since` to
/// k.
struct TrueModeExcluded {
  Index k = 0, since = 0, mode = 0;
  std::int64_t seed_offset = 0;
};

/// The bounds of one additive fault over all seeds, beside its true values where the data tell
/// them.
struct FaultStatistics {
  Index fault = 0;  ///< column of F
  Index delay =
      -1;  ///< sample time - time of the bounded value, of the last bound; -1: there was none
  std::int64_t bounds = 0;   ///< times that it was bounded
  std::int64_t checked = 0;  ///< of these, with the true value known
  std::int64_t outside =
      0;  ///< of these, with the true value outside by more than `tolerances::reported` (1e-9)
  std::int64_t excluded_0 = 0;  ///< bounds that do not hold 0: the fault is proven
  double mean_half_width = 0, last_half_width = 0;  ///< the last one of the first seed
  double rms_error = 0;                             ///< of the estimate, where checked
  double largest_share = 0;  ///< largest |estimate - truth| / half width, where checked
};

/// A true value of an additive fault outside its bounds.
struct FaultOutside {
  Index k = 0, at = 0, fault = 0;
  std::int64_t seed_offset = 0;
};

/// Bounds of the state at time k, if the plant has been in `mode`, which is monitored, since the
/// sample `since`. A mode that began later than that may have a state outside.
struct MonitoredState {
  Index k = 0, mode = 0;
  Box hull;
  Index since = 0;
};

/// What a diagnoser has found: in full for the first seed, counted over all.
struct DiagnosisOutcome {
  std::string diagnoser;
  std::vector<std::string> modes;  ///< names, in the order of the bank
  std::optional<Guarantees> guarantees;
  std::optional<DiagnosisAssumptions> assumptions;
  std::vector<DiagnosisEvent> events;  ///< first seed
  std::vector<DiagnosisSegment>
      segments;               ///< first seed; none if the data do not tell the true mode
  std::int64_t left_out = 0;  ///< events and segments beyond the first 10,000 of each
  std::int64_t runs = 0;      ///< seeds that were tried to their end
  std::int64_t steps = 0;     ///< of all of them
  std::int64_t false_alarms =
      0;  ///< a monitored mode was given up although the truth was in it all the time
  std::int64_t runs_with_false_alarm = 0;
  std::int64_t runs_with_wrong_mode = 0;  ///< some segment, the first included, has `wrong_at`
  bool truth_known = false;               ///< the data tell the true mode: what follows can be said
  std::vector<ModeStatistics> statistics;  ///< modes that occurred, by index
  DelayStatistics detection, isolation;    ///< over all modes, `isolation` over those of the bank
  std::optional<TrueModeExcluded>
      true_mode_excluded;  ///< the first; makes `violated_at` for simulated data of a linear model
  std::optional<MonitoredState> last_state;   ///< first seed, at its last step
  std::vector<FaultStatistics> faults;        ///< of diagnosers that bound additive faults
  std::optional<FaultOutside> fault_outside;  ///< the first; makes `violated_at` as well
};

/// The same as JSON objects (docs/results_format.md).
std::string json_of(const DiagnosisOutcome& outcome);
std::string json_of(const Guarantees& guarantees, const std::vector<std::string>& modes);

/// The experiments with one true mode and the designed input: as many as the study has seeds.
struct ExperimentRow {
  Index mode = 0;  ///< the true one
  std::int64_t runs = 0;
  std::vector<std::int64_t>
      possible;  ///< per mode of the bank: runs at whose end it was not excluded
  std::int64_t isolated = 0, wrong = 0, unknown_fault = 0,
               undecided = 0;      ///< runs by the last decision
  DelayStatistics isolation = {};  ///< first k from which on the true mode is isolated
};

/// A state whose bounds have become wider and wider: `last` is ten times `smallest` or more.
struct WidthGrowth {
  Index state = 0;
  Index smallest_at = 0;          ///< k of the smallest width, the first ten samples left out
  double smallest = 0, last = 0;  ///< widths
  double factor = 1;              ///< last / smallest
};
/// What may be behind it, and what to do.
std::string advice_on(const WidthGrowth& growth);

/// An assumption that the simulated truth is proven not to keep: by more than rounding, or, where
/// outward rounding excludes the truth, by rounding alone.
struct FailedAssumption {
  enum class What {
    initial_set,     ///< x_0: the observer's initial set, of a diagnoser X0 of the true mode; later
                     ///< the set that an observer begins anew from
    restart_set,     ///< x_k: the set that a diagnoser begins anew from, at a reset at k
    admissible_set,  ///< x_k
    U,               ///< u_k, of statements made in advance
    modes,           ///< the plant follows a mode that the diagnoser knows, up to k and at k
    W,               ///< what leads from x_k to x_{k+1} in the true mode
    V,               ///< what leads from x_k to y_k in the true mode
    W_exactly,       ///< the same as W, by the rounding of the simulation
    V_exactly,       ///< the same as V, by the rounding of the simulation
    invariants       ///< x_k, of a nonlinear system
  };
  What what = What::initial_set;
  Index k = 0;                   ///< of the x, u, w or v that lies outside
  Index mode = -1;               ///< whose X0, W or V it is; -1: the pipeline's or the study's own
  std::int64_t seed_offset = 0;  ///< of the run

  /// The first time that statements rest on it.
  Index from() const {
    return what == What::restart_set || what == What::W || what == What::W_exactly ? k + 1 : k;
  }
};
std::string_view to_string(FailedAssumption::What what) noexcept;
/// "W of mode \"healthy\" does not hold what leads from x_4 to x_5": for people.
std::string text_of(const FailedAssumption& failed, const std::vector<std::string>& modes);

/// Outputs that missed the prediction, and were left out.
struct LeftOut {
  Contradiction worst;
  std::vector<Index> outputs;
};

/// What an observer has estimated.
struct EstimationOutcome {
  std::string observer;
  Index lag = 0;  ///< of estimates behind the samples: there is none of the last so many times
  std::int64_t consistent = 0, inconsistent = 0,
               undecided = 0;                       ///< answers to "is the estimate non-empty?"
  std::int64_t inconsistent_from = -1;              ///< first k with an estimate called empty
  bool inconsistent_proven = false;                 ///< the host has proven it for that k
  std::optional<Contradiction> contradiction = {};  ///< of that k
  std::int64_t restarts = 0;  ///< times that the observer began anew after an empty estimate
  /// Times that it began anew from the admissible set, as no bounded set enclosed the formulas, and
  /// the first of them.
  std::int64_t not_enclosed = 0, not_enclosed_from = -1;
  std::string why_not_enclosed = {};
  std::vector<LeftOut> left_out = {};  ///< the first 10,000 samples with outliers
  std::int64_t outliers = 0;           ///< such samples in all
  std::int64_t outside_from = -1;  ///< first k with the truth outside the estimate, by more than
                                   ///< `tolerances::reported` (1e-9), as its representation says
  bool outside_proven = false;     ///< the host has proven it for that k
  AnswerCount emptiness;           ///< of every estimate
  AnswerCount containment;         ///< of the truth in estimates and admissible sets
  AnswerCount bounds;  ///< of interval hulls; unknown: infinite although the estimate is not proven
                       ///< unbounded
  std::vector<Gain> gains;
  Box last_hull;  ///< of the last estimate; dimension 0: there is none
  std::optional<WidthGrowth>
      growth;  ///< of the state that has grown most; none: the sets stay as they are
  std::int64_t inner_steps = 0;     ///< steps with an inner estimate
  std::int64_t inner_outside = -1;  ///< first k at which it leaves the hull by more than
                                    ///< `tolerances::reported` (1e-9): a defect
  double inner_share =
      0;  ///< mean width of the inner estimate / width of the hull over steps and states
  std::vector<MetricValue> summary;  ///< of the metrics
  std::size_t reproducible =
      0;  ///< the first so many of `summary` repeat from run to run; the others are measured
  PhaseTimes
      median_us;  ///< medians over the steps up to the first estimate proven empty, phase by phase
  double median_hull_us = 0;  ///< median of the interval hulls, which are not part of a step
};

/// What a designer has designed, and how experiments with its input went.
struct DesignedOutcome {
  std::string designer;
  std::string diagnoser;  ///< of the experiments; empty: there are none
  /// Of the diagnoser, counted from the start of an experiment on.
  std::optional<Index> last_used_sample = {};
  std::optional<DesignOutcome> design;   ///< nothing: the designer ended with an error
  std::optional<ExactSeparation> exact;  ///< what is proven of the input, if there is one
  std::vector<std::string> refuted;  ///< what of the designer's answer is proven false: a defect
  std::vector<ExperimentRow> experiments;  ///< by true mode
};

/// Microseconds that steps took, predict + correct + reduce or a diagnosis; 0 without steps.
struct StepTimes {
  double median = 0;
  double percentile_99 = 0;  ///< 99 of 100 steps took no longer
  double largest = 0;
};

struct PipelineOutcome : PipelineTask<EstimationOutcome, DiagnosisOutcome, DesignedOutcome> {
  std::string name = {}, backend = {};
  std::int64_t steps = 0;  ///< samples; of a diagnosis those of the first seed
  std::int64_t assumptions_until =
      -1;  ///< from this k on nothing is promised: `failed_assumption->from()`
  std::optional<FailedAssumption> failed_assumption = {};  ///< the earliest
  /// A defect: an estimate that the truth has left although all assumptions hold, which is known of
  /// simulated data only (in the nominal mode so far, and not of a Plant), or a true mode excluded.
  std::int64_t violated_at = -1;
  std::int64_t left_open = 0;  ///< steps with questions that limits of work have left open
  std::string error = {};      ///< the pipeline stopped with this error; the others go on
  std::optional<Errc> error_code = {};
  StepTimes step_us;
  double wall_s = 0;  ///< wall-clock time of the whole pipeline, data and results included
};

struct RunOutcome {
  bool interrupted = false;
  std::vector<PipelineOutcome> pipelines;
  std::vector<Measure> measures = {};  ///< what the metrics tell of their values
  std::vector<std::filesystem::path> files = {};
  std::string report_error = {};  ///< why there is no new report.html, though the results are
                                  ///< complete; empty: nothing went wrong
};

}  // namespace cordon
