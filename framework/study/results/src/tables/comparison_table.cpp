// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/comparison_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "study/results/comparable.hpp"
#include "study/results/measures.hpp"
#include "study/results/table_text.hpp"

namespace cordon {

namespace {

/// A column of the table that is made of a column of the results.
struct Column {
  std::size_t column;
  const Measure* measure;  ///< null: not described
  bool ranked = false, share = false;
  double seconds = 0;  ///< of numbers that are times k: from k to k + 1; 0: not told
};

bool is_time(std::string_view name) {
  return name == "first_detected_at" || name == "first_isolated_at";
}

/// Has the column a number in some row, and one that is worth a column?
bool is_worth(const Summary& summary, const Column& shown) {
  const Measure::Shown when = shown.measure ? shown.measure->in_comparison : Measure::Shown::always;
  if (when == Measure::Shown::never) return false;
  return std::any_of(summary.rows.begin(), summary.rows.end(), [&](const SummaryRow& row) {
    const Statistics& found = row.columns[shown.column];
    return found.infinite > 0 ||
           (found.count > 0 && (when == Measure::Shown::always || found.mean != 0));
  });
}

/// Of pipelines that run, the time of a step is of interest; of those that design, of the whole.
/// How far single steps go beyond their median is shown of single runs alone: means over
/// repetitions tell of the load of the machine.
std::vector<Column> shown_columns(const ResultTable& table, const Summary& summary) {
  std::vector<Column> found;
  for (const std::size_t column : detail::compared_columns(table)) {
    const Measure* measure = measure_of(table, table.columns[column].name);
    const bool time = is_time(table.columns[column].name);
    const Column shown{column, measure, measure && measure->ranked, measure && measure->share,
                       time ? table.sampling_time : 0};
    if (is_worth(summary, shown)) found.push_back(shown);
  }
  const std::size_t step = detail::column_of(table, "step_us"),
                    whole = detail::column_of(table, "wall_s"), none = table.columns.size();
  const bool steps =
      std::any_of(found.begin(), found.end(), [&](const Column& s) { return s.column == step; });
  if (!table.axes.empty()) {
    for (const char* name : {"step_99_us", "step_largest_us"}) {
      std::erase_if(found,
                    [&](const Column& s) { return s.column == detail::column_of(table, name); });
    }
  }
  if (steps && detail::column_of(table, "cost") == none)
    std::erase_if(found, [&](const Column& s) { return s.column == whole; });
  return found;
}

/// "1.689 ± 0.012 (∞: 2) [40]": mean and deviation of the finite numbers; how many were infinite;
/// how many there are, if fewer than the points that did not fail. Of times "81 (405)", the second
/// number in seconds.
std::string value_text(const SummaryRow& row, const Statistics& found, const Column& shown) {
  const bool percent = shown.share;
  const double scale = percent ? 100 : 1;
  const std::int64_t finished = row.points - row.failed;
  if (found.count == 0) return found.infinite > 0 ? "∞" : "–";
  std::string text = number_text(scale * found.mean);
  if (varies(found)) text += " ± " + number_text(scale * found.deviation, 2);
  if (percent) text += " %";
  if (shown.seconds > 0) text += fmt::format(" ({})", number_text(shown.seconds * found.mean));
  if (found.infinite > 0) text += fmt::format(" (∞: {})", found.infinite);
  if (found.count + found.infinite < finished) text += fmt::format(" [{}]", found.count);
  return text;
}

bool any_row(const Summary& summary, const std::vector<Column>& shown, auto&& holds) {
  return std::any_of(summary.rows.begin(), summary.rows.end(), [&](const SummaryRow& row) {
    return std::any_of(shown.begin(), shown.end(), [&](const Column& s) { return holds(row, s); });
  });
}

std::vector<std::string> notes_of(const ResultTable& table, const Summary& summary,
                                  const std::vector<Column>& shown) {
  std::vector<std::string> notes;
  std::int64_t most = 0;
  for (const SummaryRow& row : summary.rows) most = std::max(most, row.points);
  if (most > 1)
    notes.push_back(fmt::format("Mean ± standard deviation over up to {} repetitions.", most));
  const auto partial = [](const SummaryRow& row, const Column& s) {
    const Statistics& found = row.columns[s.column];
    return found.count > 0 && found.count + found.infinite < row.points - row.failed;
  };
  if (any_row(summary, shown, partial))
    notes.emplace_back("[n]: only n points have such a number; the mean is over them.");
  const auto ended = [&](const SummaryRow& row, const Column& s) {
    return row.columns[s.column].count == row.points &&
           !detail::is_comparable(table, row, s.column);
  };
  if (any_row(summary, shown, ended)) {
    notes.emplace_back(
        "†: an estimate was proven empty, the truth left what the pipeline assumes, or a guarantee "
        "was violated: its sets are "
        "not "
        "compared with the others.");
  }
  return notes;
}

}  // namespace

ComparisonTable comparison_table(const ResultTable& table, const Summary& summary) {
  ComparisonTable result;
  std::vector<std::size_t> axes;
  for (std::size_t i = 0; i < table.axes.size(); ++i) {
    if (table.axes[i].repeat) continue;
    axes.push_back(i);
    result.columns.push_back({table.axes[i].name, table.axes[i].name, false, false});
  }
  result.columns.push_back({"pipeline", "pipeline", false, false});
  const std::vector<Column> shown = shown_columns(table, summary);
  const bool failures = std::any_of(summary.rows.begin(), summary.rows.end(),
                                    [](const SummaryRow& row) { return row.failed > 0; });
  for (const Column& s : shown) {
    const std::string& name = table.columns[s.column].name;
    std::string title = detail::title_of(s.measure, name);
    if (s.seconds > 0) title += " (s)";
    result.columns.push_back({std::move(title), name, true, false});
    if (s.ranked && table.pipelines.size() > 1)
      result.columns.push_back({"× best", name, true, true});
  }
  if (failures) result.columns.push_back({"failed", "failed", true, false});
  for (const std::span<const SummaryRow> rows : detail::combinations(summary)) {
    result.groups.push_back(result.rows.size());
    const std::size_t first = result.rows.size();
    for (const SummaryRow& row : rows) {
      auto& cells = result.rows.emplace_back();
      for (const std::size_t axis : axes)
        cells.push_back({detail::axis_value(table, axis, row.at[axis]), false});
      cells.push_back({table.pipelines[row.pipeline], false});
    }
    for (const Column& s : shown) {
      const std::vector<bool> best = detail::best_of(table, rows, s.column);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const Statistics& found = rows[i].columns[s.column];
        std::string text = value_text(rows[i], found, s);
        if (found.count == rows[i].points && !detail::is_comparable(table, rows[i], s.column))
          text += " †";
        result.rows[first + i].push_back({std::move(text), best[i]});
        if (s.ranked && table.pipelines.size() > 1)
          result.rows[first + i].push_back({number_text(rows[i].relative[s.column], 3), false});
      }
    }
    for (std::size_t i = 0; failures && i < rows.size(); ++i) {
      result.rows[first + i].push_back(
          {fmt::format("{}/{}", rows[i].failed, rows[i].points), false});
    }
  }
  result.notes = notes_of(table, summary, shown);
  return result;
}

std::string number_text(double value, int digits) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0 ? "∞" : "-∞";
  const double size = std::abs(value);
  if (value == std::floor(value) && size < 1e6) return fmt::format("{:.0f}", value + 0.0);
  const std::string rounded = fmt::format("{:.{}e}", value, digits - 1);
  const int exponent = std::stoi(rounded.substr(rounded.find('e') + 1));
  if (exponent < -4 || exponent > 5) return rounded;
  return fmt::format("{:.{}f}", value, std::max(0, digits - 1 - exponent));
}

}  // namespace cordon
