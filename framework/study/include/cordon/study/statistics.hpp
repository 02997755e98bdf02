// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics of a table of results: per pipeline and combination of values, over the repetitions.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/study/result_table.hpp"

namespace cordon {

/// Of the finite numbers among some values. Quantiles interpolate linearly between order statistics
/// (type 7). No number: NaN.
struct Statistics {
  std::int64_t count = 0;          ///< finite numbers
  std::int64_t infinite = 0;       ///< infinite ones, which are left out of all that follows
  double mean = 0, deviation = 0;  ///< sample standard deviation, 0 for one number
  double min = 0, q05 = 0, q25 = 0, median = 0, q75 = 0, q95 = 0, max = 0;
};
Statistics statistics_of(std::span<const double> values);
/// Is the deviation more than what rounding makes of equal numbers? Tables show no other.
bool varies(const Statistics& found);

/// One pipeline under one combination of the axes that are not repetitions.
struct SummaryRow {
  std::size_t pipeline = 0;
  std::vector<std::size_t> at;  ///< per axis; 0 for repetitions
  std::int64_t points = 0, failed = 0;
  std::vector<Statistics> columns;  ///< by column of the table, over the points that did not fail
  /// By column: mean / smallest mean among the pipelines under the same combination. NaN where
  /// smaller is not better, a mean is not positive, or a point of the row has no finite number; but
  /// for times, also where an estimate was proven empty, the truth has left what the pipeline
  /// assumes, or a guarantee was violated.
  std::vector<double> relative;
};

struct Summary {
  std::vector<SummaryRow> rows;  ///< by combination, then by pipeline
};
Summary summarise(const ResultTable& table);

/// What is known of a column: told by its metric, or of a number that the host finds itself; null
/// if it is not described.
const Measure* measure_of(const ResultTable& table, std::string_view column);
/// "mean radius", "step time [µs]"; without a title the name of the value.
std::string title_of(const Measure& measure);
/// The same where there is less room.
std::string short_title_of(const Measure& measure);
/// Is less of this number better, more, or neither?
Preference preference_of(const ResultTable& table, std::string_view column);

}  // namespace cordon
