// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "study/results/comparable.hpp"

namespace cordon {

namespace {

/// Linear between order statistics (type 7).
double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - std::floor(place));
}

/// Sums over sorted values: the same to the last bit whatever their order was. The wider type keeps
/// squares in range.
void add_moments(Statistics& found, const std::vector<double>& sorted) {
  const auto n = static_cast<long double>(sorted.size());
  long double sum = 0;
  for (const double x : sorted) sum += static_cast<long double>(x);
  const long double mean = sum / n;
  long double squares = 0;
  for (const double x : sorted)
    squares += (static_cast<long double>(x) - mean) * (static_cast<long double>(x) - mean);
  found.mean = std::clamp(static_cast<double>(mean), sorted.front(), sorted.back());
  found.deviation = sorted.size() < 2 ? 0 : static_cast<double>(std::sqrt(squares / (n - 1)));
  if (sorted.front() == sorted.back()) found.deviation = 0;
}

/// `relative` of one column over the rows of one combination.
void add_relative(const ResultTable& table, std::span<SummaryRow> rows, std::size_t column) {
  if (preference_of(table, table.columns[column].name) != Preference::less) return;
  double smallest = infinity;
  for (const SummaryRow& row : rows) {
    if (detail::is_comparable(table, row, column))
      smallest = std::min(smallest, row.columns[column].mean);
  }
  if (!(smallest > 0)) return;
  for (SummaryRow& row : rows) {
    if (detail::is_comparable(table, row, column))
      row.relative[column] = row.columns[column].mean / smallest;
  }
}

}  // namespace

bool varies(const Statistics& found) {
  constexpr double rounding = 1e-12;
  return found.deviation > rounding * std::max(std::abs(found.min), std::abs(found.max));
}

Statistics statistics_of(std::span<const double> values) {
  Statistics found;
  std::vector<double> sorted;
  for (const double x : values) {
    if (std::isfinite(x)) sorted.push_back(x);
    found.infinite += std::isinf(x);
  }
  found.count = static_cast<std::int64_t>(sorted.size());
  if (sorted.empty()) {
    found.mean = found.deviation = found.min = found.q05 = found.q25 = found.median = found.q75 =
        found.q95 = found.max = not_available;
    return found;
  }
  std::sort(sorted.begin(), sorted.end());
  add_moments(found, sorted);
  found.min = sorted.front();
  found.q05 = quantile(sorted, .05);
  found.q25 = quantile(sorted, .25);
  found.median = quantile(sorted, .5);
  found.q75 = quantile(sorted, .75);
  found.q95 = quantile(sorted, .95);
  found.max = sorted.back();
  return found;
}

Summary summarise(const ResultTable& table) {
  std::map<std::tuple<std::vector<std::size_t>, std::size_t>, std::vector<const ResultRow*>> groups;
  for (const ResultRow& row : table.rows) {
    std::vector<std::size_t> at = row.at;
    for (std::size_t i = 0; i < at.size() && i < table.axes.size(); ++i) {
      if (table.axes[i].repeat) at[i] = 0;
    }
    groups[{std::move(at), row.pipeline}].push_back(&row);
  }
  Summary summary;
  for (const auto& [key, points] : groups) {
    SummaryRow& row = summary.rows.emplace_back();
    std::tie(row.at, row.pipeline) = key;
    row.points = static_cast<std::int64_t>(points.size());
    row.relative.assign(table.columns.size(), not_available);
    std::vector<const ResultRow*> finished;
    for (const ResultRow* point : points) {
      if (point->error.empty()) finished.push_back(point);
    }
    row.failed = row.points - static_cast<std::int64_t>(finished.size());
    std::vector<double> values;
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
      values.clear();
      for (const ResultRow* point : finished)
        values.push_back(column < point->values.size() ? point->values[column] : not_available);
      row.columns.push_back(statistics_of(values));
    }
  }
  for (const std::span<SummaryRow> rows : detail::combinations(summary)) {
    for (std::size_t column = 0; column < table.columns.size(); ++column)
      add_relative(table, rows, column);
  }
  return summary;
}

}  // namespace cordon
