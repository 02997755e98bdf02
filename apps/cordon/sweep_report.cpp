// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep_report.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common.hpp"
#include "json_text.hpp"
#include "observer_report.hpp"
#include "study/results/table_text.hpp"

namespace cordon::apps {

namespace {

using nlohmann::ordered_json;

constexpr std::size_t most_rows = 120, most_failures = 5;

/// "second, budget = 20, seed = 3".
std::string place_of(const ResultTable& table, const ResultRow& row) {
  std::string text = table.pipelines[row.pipeline];
  for (std::size_t i = 0; i < table.axes.size(); ++i) {
    text += fmt::format(", {} = {}", table.axes[i].name, detail::axis_value(table, i, row.at[i]));
  }
  return text;
}

std::string failures_text(const ResultTable& table) {
  std::string text;
  std::size_t shown = 0, failed = 0;
  for (const ResultRow& row : table.rows) {
    if (row.error.empty()) continue;
    if (++failed > most_failures) continue;
    ++shown;
    text += fmt::format("  {}: {}\n", place_of(table, row), row.error);
  }
  if (failed == 0) return "";
  if (failed > shown) text += fmt::format("  and {} more, in points.csv\n", failed - shown);
  return fmt::format("{} of {} points failed and count nowhere else:\n", failed,
                     table.rows.size()) +
         text + "\n";
}

ordered_json statistics_json(const Statistics& found, double relative) {
  return {{"count", found.count},
          {"infinite", found.infinite},
          {"mean", json_number(found.mean)},
          {"deviation", json_number(found.deviation)},
          {"min", json_number(found.min)},
          {"q05", json_number(found.q05)},
          {"q25", json_number(found.q25)},
          {"median", json_number(found.median)},
          {"q75", json_number(found.q75)},
          {"q95", json_number(found.q95)},
          {"max", json_number(found.max)},
          {"relative", json_number(relative)}};
}

/// {axis: value} of the axes that are not repetitions.
ordered_json values_json(const ResultTable& table, const std::vector<std::size_t>& at) {
  ordered_json values = ordered_json::object();
  for (std::size_t i = 0; i < table.axes.size(); ++i) {
    if (!table.axes[i].repeat)
      values[table.axes[i].name] = ordered_json::parse(table.axes[i].values[at[i]]);
  }
  return values;
}

}  // namespace

std::string comparison_text(const ComparisonTable& table, std::size_t limit) {
  std::vector<std::vector<std::string>> rows(1);
  for (const ComparisonColumn& column : table.columns) rows[0].push_back(heading(column.title));
  bool any_best = false;
  const std::size_t shown = std::min(limit, table.rows.size());
  for (std::size_t i = 0; i < shown; ++i) {
    const bool begins =
        std::find(table.groups.begin(), table.groups.end(), i) != table.groups.end();
    if (begins && i > 0 && table.groups.size() < table.rows.size()) rows.emplace_back();
    auto& cells = rows.emplace_back();
    for (const ComparisonCell& cell : table.rows[i]) {
      cells.push_back(cell.best ? cell.text + " *" : cell.text);
      any_best = any_best || cell.best;
    }
  }
  std::string text = apps::table(rows, Paint(stdout));
  if (shown < table.rows.size())
    text += fmt::format("… and {} more rows, in summary.md\n", table.rows.size() - shown);
  if (any_best) text += "\n*: the best beside it.";
  for (const std::string& note : table.notes) text += (text.ends_with('\n') ? "\n" : " ") + note;
  return text.ends_with('\n') ? text : text + "\n";
}

std::string sweep_report_text(const SweepOutcome& outcome, const std::filesystem::path& out,
                              bool has_page) {
  const ResultTable& table = outcome.table;
  std::string text = table.title.empty() ? "" : Paint(stdout).bold(table.title) + "\n\n";
  text += comparison_text(comparison_table(table, summarise(table)), most_rows) + "\n";
  text += failures_text(table);
  text += fmt::format(
      "{} points are in {}: {}summary.tex and summary.md to print, points.csv and summary.csv to "
      "go "
      "on with\n",
      table.rows.size(), out.string(), has_page ? "report.html to look at, " : "");
  return text;
}

std::string sweep_report_json(const SweepOutcome& outcome) {
  const ResultTable& table = outcome.table;
  ordered_json rows = ordered_json::array(), files = ordered_json::array();
  for (const SummaryRow& row : summarise(table).rows) {
    ordered_json numbers = ordered_json::object();
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      if (row.columns[i].count + row.columns[i].infinite == 0) continue;
      numbers[table.columns[i].name] = statistics_json(row.columns[i], row.relative[i]);
    }
    rows.push_back({{"pipeline", table.pipelines[row.pipeline]},
                    {"at", values_json(table, row.at)},
                    {"points", row.points},
                    {"failed", row.failed},
                    {"numbers", std::move(numbers)}});
  }
  for (const std::filesystem::path& file : outcome.files) files.push_back(file.string());
  const ordered_json report{{"title", table.title},
                            {"points", outcome.progress.total},
                            {"failed", outcome.progress.failed},
                            {"resumed", outcome.progress.resumed},
                            {"violated", outcome.violated},
                            {"summary", std::move(rows)},
                            {"files", std::move(files)}};
  return json_text(report);
}

}  // namespace cordon::apps
