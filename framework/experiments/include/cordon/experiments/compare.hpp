// SPDX-License-Identifier: GPL-3.0-or-later
// Finished runs or sweeps side by side: which numbers are the same, and whether times differ by
// more than chance.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cordon/study/statistics.hpp"

namespace cordon {

/// A finished run or sweep.
struct ComparedRun {
  std::string directory, version, study_hash, host;
};

/// Times of one program on one machine differ by as much, whatever the repetitions tell: the load,
/// the clock and the place in memory of a process move all of them together.
inline constexpr double machine_noise = 1.15;

/// Measured times of a run beside those of the first run, over repetitions: do they differ by more
/// than the noise of machines?
struct TimeTest {
  std::int64_t first = 0, other = 0;  ///< numbers of measurements
  double ratio = 0, lower = 0,
         upper = 0;  ///< median ratio to the first run, with an interval that lies beyond the
                     ///< noise exactly if `significant`, at the confidence that takes; NaN: none
  double p = 1;  ///< Mann–Whitney, two-sided, adjusted (Holm) for all tests of the same measure
  double least = 1;  ///< the smallest p that as many measurements can have, if all tests of the
                     ///< measure are as clear
  bool significant() const { return p < .05; }
  bool too_few() const { return !significant() && !(least < .05); }
};

/// One number of one pipeline under one combination of values in one run.
struct ComparedNumber {
  Statistics statistics;                ///< over the repetitions that did not fail
  std::int64_t points = 0, failed = 0;  ///< of this run
  std::int64_t common = 0;              ///< points that both have, by their values
  std::int64_t finished = 0;            ///< of these, points that failed in neither
  std::int64_t different = 0;           ///< of these, points at which the number is another one
  std::int64_t paired = 0;              ///< points that have a finite number in both
  double difference = 0,
         ratio = 0;  ///< of the mean over these to that of the first run; NaN: cannot be said
  std::optional<TimeTest> test =
      {};  ///< of measured numbers, where there is more than one measurement
};

struct ComparedRow {
  std::string pipeline;
  std::vector<std::string> at;       ///< values of the axes that are not repetitions, as JSON
  std::vector<ComparedNumber> runs;  ///< by run; the first one beside itself
};

struct ComparedMeasure {
  ResultColumn column;
  std::vector<ComparedRow> rows;  ///< of those that have the number in some run
  bool is_equal() const;  ///< in every row all runs have the points of the first, with the same
                          ///< failures and the same numbers
};

struct Comparison {
  std::vector<ComparedRun> runs;
  std::vector<std::string> axes;  ///< names of those that are not repetitions
  /// Per axis: what values are called, where the first run calls them something.
  std::vector<std::map<std::string, std::string>> labels = {};
  std::vector<ComparedMeasure> measures;  ///< in the order of the results
  std::vector<std::string> warnings;  ///< different studies, programs or machines; failed points;
                                      ///< pipelines that only some have
};

/// Joins two or more directories by the names of pipelines and the values of axes. Throws
/// InputError: one cannot be read, or their axes have different names.
Comparison compare_results(const std::vector<std::filesystem::path>& directories);

}  // namespace cordon
