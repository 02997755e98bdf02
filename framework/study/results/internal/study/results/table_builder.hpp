// SPDX-License-Identifier: GPL-3.0-or-later
// Makes a table of results row by row.
#pragma once

#include <string>
#include <unordered_map>

#include "cordon/study/result_table.hpp"
#include "study/text/json_cursor.hpp"

namespace cordon::detail {

/// Columns come in the order of their first appearance.
class TableBuilder {
 public:
  explicit TableBuilder(ResultTable& table) : table_(table) {}

  /// `numbers` go to the row; NaN makes no column.
  void add(ResultRow row, const std::vector<ResultNumber>& numbers);
  /// More numbers of a row that was added before.
  void extend(std::size_t row, const std::vector<ResultNumber>& numbers);
  /// All rows get as many values as there are columns.
  void finish();

 private:
  std::size_t column(const ResultColumn& column);

  ResultTable& table_;
  std::unordered_map<std::string, std::size_t> known_;
};

/// Of the study in results.json, in seconds; 0: it tells none.
double sampling_time_of(const json::Cursor& results);

/// What a study tells of the time of a step, if no axis changes it; else 0.
double common_sampling_time(double of_study, const std::vector<SweepAxis>& axes);

/// The table of a run: one row per pipeline, no axes.
ResultTable table_of(const Study& study, const RunOutcome& outcome);

}  // namespace cordon::detail
