// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a study: every pipeline over the same data, results streamed to files that appear whole or not at all.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cordon/study/data.hpp"
#include "cordon/study/study.hpp"

namespace cordon {

struct RunOptions {
  std::filesystem::path out;                ///< directory of the results; empty: none are written
  const std::atomic<bool>* stop = nullptr;  ///< set from a signal handler: the run ends with `interrupted`, old results stay
  /// Called now and then: pipeline index, records done, records in all (0: unknown).
  std::function<void(std::size_t, std::int64_t, std::int64_t)> progress;
};

/// How many questions of a kind a run has asked, by what became of them.
struct AnswerCount {
  std::int64_t proven = 0, unknown = 0;
  void add(bool is_proven) { ++(is_proven ? proven : unknown); }
};

struct PipelineOutcome {
  std::string name, backend, observer;
  std::int64_t steps = 0;
  std::int64_t consistent = 0, inconsistent = 0, undecided = 0;  ///< answers to "is the estimate non-empty?"
  std::int64_t inconsistent_from = -1;                           ///< first k with an estimate proven empty
  std::int64_t assumptions_until = -1;  ///< first k at which the truth is proven outside the pipeline's own assumptions
  std::int64_t outside_from = -1;  ///< first k with the truth proven outside the estimate, by more than rounding (1e-9 relative)
  std::int64_t violated_at = -1;   ///< `outside_from` where all assumptions hold, which is known of simulated data only: a defect
  AnswerCount emptiness;           ///< of every estimate
  AnswerCount containment;         ///< of the truth in estimates and admissible sets
  AnswerCount bounds;              ///< of interval hulls; unknown: infinite although the estimate is not proven unbounded
  std::string error;               ///< the pipeline stopped with this error; the others go on
  std::optional<Errc> error_code;
  std::vector<MetricValue> summary;
  PhaseTimes median_us;       ///< medians over the steps up to the first estimate proven empty, phase by phase
  double median_step_us = 0;  ///< median of predict + correct + reduce
  double median_hull_us = 0;  ///< median of the interval hulls, which are not part of a step
  double wall_s = 0;          ///< wall-clock time of the whole pipeline, data and results included
};

struct RunOutcome {
  bool interrupted = false;
  std::vector<PipelineOutcome> pipelines;
  std::vector<std::filesystem::path> files;
};

/// Runs all pipelines, one after another. `out` receives results.json, sets.jsonl, data.csv, steps.csv, summary.csv (the same
/// bytes whenever the run is repeated) and run.json (host, times). They are written beside the old ones, renamed at the end, and
/// removed if the run fails or is interrupted. Throws InputError for bad data, Errc::io when results cannot be written: old ones
/// are left as they were. An exception of a component ends its pipeline only. Memory does not depend on the number of steps.
RunOutcome run_study(const Study& study, const Registry& registry, const RunOptions& options);

}  // namespace cordon
