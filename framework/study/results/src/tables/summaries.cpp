// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/results/summaries.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cordon/study/comparison_table.hpp"
#include "study/results/comparable.hpp"
#include "study/results/results_parts.hpp"
#include "study/results/table_text.hpp"
#include "study/text/numbers.hpp"
#include "tables/latex_table.hpp"

namespace cordon::detail {

namespace {

constexpr std::size_t whole = std::string::npos;  ///< values of axes are not cut

void write_statistics(Sink& file, const ResultTable& table, const Summary& summary, bool measured) {
  std::vector<std::string> header{"pipeline"};
  for (const SweepAxis& axis : table.axes) {
    if (!axis.repeat) header.push_back(csv_field(axis.name));
  }
  for (const char* name : {"measure", "points", "failed", "count", "infinite", "mean", "deviation",
                           "min", "q05", "q25", "median", "q75", "q95", "max", "relative"}) {
    header.emplace_back(name);
  }
  file.write(joined(header));
  for (const SummaryRow& row : summary.rows) {
    std::vector<std::string> beginning{csv_field(table.pipelines[row.pipeline])};
    for (std::size_t i = 0; i < table.axes.size(); ++i) {
      if (!table.axes[i].repeat)
        beginning.push_back(csv_field(axis_value(table, i, row.at[i], whole)));
    }
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
      const Statistics& found = row.columns[column];
      if (table.columns[column].measured != measured || found.count + found.infinite == 0) continue;
      std::vector<std::string> fields = beginning;
      fields.push_back(csv_field(table.columns[column].name));
      for (const std::int64_t count : {row.points, row.failed, found.count, found.infinite})
        fields.push_back(std::to_string(count));
      for (const double x : {found.mean, found.deviation, found.min, found.q05, found.q25,
                             found.median, found.q75, found.q95, found.max, row.relative[column]}) {
        fields.push_back(csv_number(x));
      }
      file.write(joined(fields));
    }
  }
}

void write_markdown(Sink& file, const std::string& title, const ComparisonTable& table) {
  file.write(fmt::format("## {}\n\n", markdown_text(title)));
  std::string header = "|", line = "|";
  for (const ComparisonColumn& column : table.columns) {
    header += fmt::format(" {} |", markdown_text(column.title));
    line += column.number ? " ---: |" : " --- |";
  }
  file.write(header + "\n" + line + "\n");
  for (const auto& row : table.rows) {
    std::string cells = "|";
    for (const ComparisonCell& cell : row) {
      const std::string text = markdown_text(cell.text);
      cells += fmt::format(fmt::runtime(cell.best ? " **{}** |" : " {} |"), text);
    }
    file.write(cells + "\n");
  }
  for (const std::string& note : table.notes)
    file.write(fmt::format("\n{}\n", markdown_text(note)));
}

/// Did everything hold that the pipeline claims? "1", "0", or nothing if it did not come to its end
/// or has no answer; of a design "infeasible" if its designer says that no input separates the
/// modes.
std::string verdict(const ResultTable& table, const ResultRow& row) {
  if (!row.error.empty()) return "";
  const auto value = [&](std::string_view name) {
    const std::size_t column = column_of(table, name);
    return column < row.values.size() ? row.values[column] : std::nan("");
  };
  if (value("refuted_claims") > 0) return "0";
  if (!std::isnan(value("violated_at")) || !std::isnan(value("inner_outside")) ||
      value("inconsistent") > 0)
    return "0";
  if (value("infeasible") == 1) return "infeasible";
  if (!std::isnan(value("horizon")))
    return std::isnan(value("separates")) ? "" : to_text(value("separates"));
  return "1";
}

void write_benchmarks(Sink& file, const ResultTable& table) {
  file.write(joined({"benchmark", "instance", "result", "time"}));
  const std::size_t wall = column_of(table, "wall_s");
  for (const ResultRow& row : table.rows) {
    std::string instance = table.pipelines[row.pipeline];
    for (std::size_t i = 0; i < table.axes.size(); ++i) {
      instance += fmt::format("{}{}={}", i == 0 ? " " : ",", table.axes[i].name,
                              axis_value(table, i, row.at[i], whole));
    }
    const std::string time = wall < row.values.size() ? csv_number(row.values[wall]) : "";
    file.write(joined({csv_field(table.title), csv_field(instance), verdict(table, row), time}));
  }
}

}  // namespace

TableFiles::TableFiles(AtomicDirectory& directory)
    : tex_(directory.create("summary.tex")),
      markdown_(directory.create("summary.md")),
      benchmarks_(directory.create("benchmarks.csv")) {}

void TableFiles::write(const ResultTable& table, const Summary& summary) const {
  const ComparisonTable compared = comparison_table(table, summary);
  write_latex(tex_, table.title, compared);
  write_markdown(markdown_, table.title, compared);
  write_benchmarks(benchmarks_, table);
}

void write_summaries(AtomicDirectory& directory, const ResultTable& table, const Summary& summary) {
  write_statistics(directory.create("summary.csv"), table, summary, false);
  write_statistics(directory.create("times.csv"), table, summary, true);
  TableFiles(directory).write(table, summary);
}

}  // namespace cordon::detail
