// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/comparable.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/tolerances.hpp"

namespace cordon::detail {

namespace {

template <class Row, class Rows>
std::vector<std::span<Row>> split(Rows& rows) {
  std::vector<std::span<Row>> found;
  for (std::size_t begin = 0; begin < rows.size();) {
    std::size_t end = begin;
    while (end < rows.size() && rows[end].at == rows[begin].at) ++end;
    found.emplace_back(&rows[begin], end - begin);
    begin = end;
  }
  return found;
}

/// At some point an estimate was proven empty, the truth left what is assumed of it, or a guarantee
/// was violated.
bool ends_early(const ResultTable& table, const SummaryRow& row) {
  const auto happened = [&](std::string_view name) {
    const std::size_t column = column_of(table, name);
    return column < table.columns.size() && row.columns[column].count > 0;
  };
  return happened("inconsistent_from") || happened("assumptions_until") ||
         happened("violated_at") || happened("inner_outside");
}

}  // namespace

bool are_alike(const ResultTable& table, std::size_t column, double a, double b) {
  const Measure* measure = measure_of(table, table.columns[column].name);
  const double apart = std::abs(a - b);
  return apart <= tolerances::reported * std::max(std::abs(a), std::abs(b)) ||
         (measure && measure->share && apart <= tolerances::reported);
}

std::size_t column_of(const ResultTable& table, std::string_view name) {
  const auto found = std::find_if(table.columns.begin(), table.columns.end(),
                                  [&](const ResultColumn& column) { return column.name == name; });
  return static_cast<std::size_t>(found - table.columns.begin());
}

bool is_comparable(const ResultTable& table, const SummaryRow& row, std::size_t column) {
  return row.columns[column].count == row.points &&
         (table.columns[column].measured || !ends_early(table, row));
}

std::vector<std::span<SummaryRow>> combinations(Summary& summary) {
  return split<SummaryRow>(summary.rows);
}
std::vector<std::span<const SummaryRow>> combinations(const Summary& summary) {
  return split<const SummaryRow>(summary.rows);
}

std::vector<bool> best_of(const ResultTable& table, std::span<const SummaryRow> rows,
                          std::size_t column) {
  const Preference preference = preference_of(table, table.columns[column].name);
  std::vector<bool> best(rows.size());
  double smallest = infinity, largest = -infinity;
  for (const SummaryRow& row : rows) {
    if (!is_comparable(table, row, column)) continue;
    smallest = std::min(smallest, row.columns[column].mean);
    largest = std::max(largest, row.columns[column].mean);
  }
  if (preference == Preference::none || !(smallest < largest) ||
      are_alike(table, column, smallest, largest))
    return best;
  const double wanted = preference == Preference::less ? smallest : largest;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    best[i] = is_comparable(table, rows[i], column) &&
              are_alike(table, column, rows[i].columns[column].mean, wanted);
  }
  return best;
}

}  // namespace cordon::detail
