// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a study over all combinations of the values of its sweep, in parallel, in parts, and on
// after an interruption.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/study/result_table.hpp"
#include "cordon/study/sweep_grid.hpp"

namespace cordon {

/// A part of a sweep: point i with combination q and pipeline p belongs to part 1 + (q + p) mod
/// `of`.
struct Shard {
  std::int64_t part = 1, of = 1;
  bool has(const SweepPoint& point, std::size_t pipelines) const;
};

struct SweepProgress {
  std::int64_t done = 0, total = 0;  ///< points, of this part
  std::int64_t failed = 0;
  std::int64_t resumed = 0;  ///< of those done, by an earlier process
  double elapsed_s = 0;      ///< of this process
};

struct SweepOptions {
  std::filesystem::path out;  ///< directory of the results
  int jobs = 1;               ///< threads; results do not depend on it
  bool resume = false;  ///< go on after what an interrupted run of the same sweep has left in `out`
  bool restart =
      false;  ///< throw away what an interrupted run of any sweep has left there; not with `resume`
  double point_limit_s = infinity;  ///< wall-clock time of one point, tested between
                                    ///< its steps
  Shard shard;
  bool report = true;  ///< write report.html as well, after the results
  const std::atomic<bool>* stop =
      nullptr;  ///< set from a signal handler: what is finished is kept for `resume`
  std::function<void(const SweepProgress&)>
      progress;  ///< called now and then, from one thread at a time
};

struct SweepOutcome {
  bool interrupted = false;
  SweepProgress progress;
  ResultTable table;          ///< of all points of this part, empty if interrupted
  std::int64_t violated = 0;  ///< points at which a guarantee was violated
  std::optional<Errc> first_error =
      {};  ///< of the failed point with the smallest index, where it was run or resumed
  std::vector<std::filesystem::path> files;
  std::string report_error = {};  ///< as in RunOutcome
};

/// Every point is run on its own: it fails, runs into its limit or violates a guarantee without
/// stopping the others, and what became of it stands in its row. Writes results.json, points.csv,
/// run.json and the summaries of `summarise`; all but times are the same bytes whatever `jobs`,
/// interruptions and shards were. While it runs, finished points are kept in a journal in `out`,
/// which survives the death of the process at any time. With `resume`, and finished results of the
/// same sweep in `out`, nothing is run: they are read, and their report is written if it is
/// missing. Throws InputError: `out` holds the unfinished sweep of another study, or one of this
/// study without `resume`, or another process works there; Errc::io, and the journal stays.
SweepOutcome run_sweep(const Study& study, const Registry& registry, const SweepOptions& options);

/// Joins the results of all parts of one sweep in `out`: the same files that one process would have
/// left. Throws InputError if parts are missing, come twice, or belong to different studies or
/// builds.
SweepOutcome merge_sweeps(const std::vector<std::filesystem::path>& parts,
                          const std::filesystem::path& out);

}  // namespace cordon
