// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a study: every pipeline over the same data, results streamed to files that appear whole or
// not at all.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/study/data.hpp"
#include "cordon/study/outcome.hpp"
#include "cordon/study/study.hpp"

namespace cordon {

/// Which estimates' sets go into sets.jsonl: of every step, of each pipeline's last one, or none.
enum class KeptSets { all, last, none };

std::string_view to_string(KeptSets sets);

struct RunOptions {
  std::filesystem::path out;  ///< directory of the results; empty: none are written
  KeptSets sets = KeptSets::all;
  /// Called once, early, where all sets take more than 100 MB: how many bytes they will take if
  /// they go on as they began, or 0 where the number of samples is not known, once they have taken
  /// so many.
  std::function<void(double bytes)> many_sets = {};
  std::string pipeline = {};  ///< run this one only; empty: all
  const std::atomic<bool>* stop =
      nullptr;  ///< set from a signal handler: the run ends with `interrupted`, old results stay
  /// When to give a pipeline up: it ends with an error (Errc::time_limit) like any other; tested
  /// between steps.
  std::optional<std::chrono::steady_clock::time_point> deadline = {};
  /// Adds to results that are complete, while their directory is still held: `add_report`
  /// (experiments/report.hpp). Its new files go to the list; returned is why there are none, or "".
  std::function<std::string(const std::filesystem::path& directory,
                            std::vector<std::filesystem::path>& files)>
      report = {};
  /// Called now and then: pipeline index, records done, records in all (0: unknown).
  std::function<void(std::size_t, std::int64_t, std::int64_t)> progress;
};

/// Runs all pipelines, one after another; those with a diagnoser on all seeds of simulated data, of
/// which the first is written. `out` receives results.json, sets.jsonl, data.csv, steps.csv,
/// summary.csv, diagnosis.csv if there are diagnosers (the same bytes whenever the run is repeated)
/// and run.json (host, times). They are written beside the old ones, renamed at the end, and
/// removed if the run fails or is interrupted. Throws InputError for bad data, Errc::io when
/// results cannot be written: old ones are left as they were. An exception of a component ends its
/// pipeline only. Memory does not depend on the number of steps.
RunOutcome run_study(const Study& study, const Registry& registry, const RunOptions& options);

}  // namespace cordon
