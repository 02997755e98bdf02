// SPDX-License-Identifier: GPL-3.0-or-later
// The results of a run or a sweep as a table of numbers: what statistics, comparisons and reports
// are made of.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cordon/interfaces/metric.hpp"
#include "cordon/study/run.hpp"
#include "cordon/study/study.hpp"

namespace cordon {

struct ResultColumn {
  std::string name;
  bool measured = false;  ///< a time: differs from run to run
  friend bool operator==(const ResultColumn&, const ResultColumn&) = default;
};

/// A number among the results of a pipeline; NaN: not available, ±∞ as it is.
struct ResultNumber {
  ResultColumn column;
  double value = 0;
};

/// Everything of an outcome that is a number, under the names of docs/results_format.md: counts,
/// summaries of metrics, delays and rates of diagnoses, cost and separation of designs, and times.
/// Answers count 1 for yes, 0 for no, NaN for unknown.
std::vector<ResultNumber> numbers_of(const PipelineOutcome& outcome);

struct ResultRow {
  std::size_t pipeline = 0;
  std::vector<std::size_t> at;  ///< per axis: index of the value
  std::vector<double> values;   ///< by column, NaN where there is none
  std::string error;            ///< why the point failed; empty: it did not
};

struct ResultTable {
  std::string title;
  std::string study_hash;
  std::string version;  ///< of the program
  std::vector<SweepAxis> axes;
  std::vector<std::string> pipelines;
  std::vector<ResultColumn> columns;   ///< those of any row, in the order of their first appearance
  std::vector<ResultRow> rows;         ///< by point
  std::vector<Measure> measures = {};  ///< what the metrics tell of their columns
  double sampling_time = 0;  ///< seconds from k to k + 1; 0: not known, or not that of all points
};

/// Reads a finished run (one row per pipeline, no axes) or a finished sweep. Throws InputError.
ResultTable read_result_table(const std::filesystem::path& directory);

}  // namespace cordon
