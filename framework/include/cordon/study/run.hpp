// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a study: every pipeline over the same data, results streamed to files that appear whole or not at all.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
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

struct PipelineOutcome {
  std::string name, backend, observer;
  std::int64_t steps = 0;
  std::int64_t consistent = 0, inconsistent = 0, undecided = 0;  ///< answers to "is the estimate non-empty?"
  std::int64_t inconsistent_from = -1;   ///< first k with an estimate proven empty
  std::int64_t assumptions_until = -1;   ///< first k at which the truth is proven outside the pipeline's own assumptions
  std::int64_t violated_at = -1;         ///< first k with the truth proven outside although all assumptions hold: a defect
  std::string error;                     ///< the pipeline stopped with this error; the others go on
  std::vector<MetricValue> summary;
  PhaseTimes median_us;                  ///< medians over the steps
};

struct RunOutcome {
  bool interrupted = false;
  std::vector<PipelineOutcome> pipelines;
  std::vector<std::filesystem::path> files;
};

/// Runs all pipelines. Throws Errc::io when results cannot be written (old ones are left as they were).
RunOutcome run_study(const Study& study, const Registry& registry, const RunOptions& options);

}  // namespace cordon
