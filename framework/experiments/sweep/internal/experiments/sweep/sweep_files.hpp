// SPDX-License-Identifier: GPL-3.0-or-later
// The files of a finished sweep, or of one of its parts: results.json, points.csv, run.json and the
// summaries.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "experiments/sweep/rows.hpp"
#include "study/text/directory_lock.hpp"

namespace cordon::detail {

/// What stands in the files before the points: JSON objects that are open after their last complete
/// member.
struct SweepHeads {
  std::string results, run;
  friend bool operator==(const SweepHeads&, const SweepHeads&) = default;
};
SweepHeads heads_of(const Study& study, const Registry& registry, const std::string& started,
                    double limit_s);

/// All of a sweep that its files tell.
struct SweepFiles {
  SweepHeads heads;
  Study study;  ///< title, axes, and the names of the pipelines: as `heads.results` tells them
  std::string study_hash, version, abi_tag;
  std::vector<Measure> measures = {};  ///< what the metrics tell of their numbers
  double limit_s = infinity;           ///< of a point
  std::optional<Shard> shard;          ///< of a part
  SweepRows rows;
  double wall_s = 0;
  std::string finished = {};
};

/// Takes what the head of results.json tells. Throws InputError, which names the file.
void read_head(SweepFiles& sweep, const std::filesystem::path& file);

ResultTable table_of(const SweepFiles& sweep);

/// All files appear in the directory of `out`, or none does. Returns them.
std::vector<std::filesystem::path> write_sweep(const DirectoryLock& out, const SweepFiles& sweep,
                                               const ResultTable& table);

/// Reads results.json and run.json line by line: memory holds the numbers only. Throws InputError,
/// also if they do not hold every point of the sweep, or of the part.
SweepFiles read_sweep(const std::filesystem::path& directory);

}  // namespace cordon::detail
