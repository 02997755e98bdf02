// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "cordon/study/comparison_table.hpp"
#include "cordon/study/result_table.hpp"
#include "cordon/study/statistics.hpp"
#include "core/text.hpp"
#include "figures/figures.hpp"
#include "study/results/comparable.hpp"
#include "study/results/table_text.hpp"
#include "study/text/numbers.hpp"

namespace cordon::report {

namespace {

constexpr std::size_t most_measures = 12, most_rows = 400;
constexpr double clear_margin = 0.5;  ///< a lead over the next that is shaded fully

/// What pipelines are held against each other by.
struct Measure {
  std::string title;
  std::size_t column = 0;
};

std::vector<Measure> measures_of(const ResultTable& table, const ComparisonTable& comparison) {
  std::vector<Measure> measures;
  for (const ComparisonColumn& column : comparison.columns) {
    const std::size_t at = detail::column_of(table, column.name);
    const bool counts = column.number && at < table.columns.size() &&
                        preference_of(table, column.name) != Preference::none;
    // A comparison shows some numbers twice: as they are, and relative to the best.
    const bool again = std::any_of(measures.begin(), measures.end(),
                                   [at](const Measure& one) { return one.column == at; });
    if (counts && !again && measures.size() < most_measures) measures.push_back({column.title, at});
  }
  return measures;
}

std::vector<std::size_t> factors_of(const ResultTable& table) {
  std::vector<std::size_t> factors;
  for (std::size_t i = 0; i < table.axes.size(); ++i) {
    if (!table.axes[i].repeat) factors.push_back(i);
  }
  return factors;
}

void add_comparison(const ComparisonTable& comparison, const RunFiles& files, Report& report) {
  Table table;
  std::string measure;
  for (const ComparisonColumn& column : comparison.columns) {
    if (!column.relative) measure = column.title;
    // Beside its measure on the page; in a file every column has a name of its own.
    const bool named = column.relative && files.detail() == Detail::all;
    table.header.push_back(named ? fmt::format("{} {}", measure, column.title) : column.title);
  }
  for (const auto& row : comparison.rows) {
    if (files.detail() == Detail::page && table.rows.size() == most_rows) break;
    auto& cells = table.rows.emplace_back();
    for (std::size_t j = 0; j < row.size(); ++j)
      cells.push_back({row[j].text, row[j].best, 0, comparison.columns[j].number});
  }
  if (table.rows.empty()) return;
  if (table.rows.size() < comparison.rows.size()) {
    report.notes.push_back(
        fmt::format("The first {} of {} rows of the comparison are shown; summary.csv holds all.",
                    table.rows.size(), comparison.rows.size()));
  }
  std::string caption = files.is_sweep() ? "Means ± standard deviations over the repetitions."
                                         : "The numbers of all pipelines.";
  for (const std::string& note : comparison.notes) caption += ' ' + note;
  report.figures.push_back(
      {"comparison", section::comparison, "Comparison", std::move(caption), std::move(table)});
}

/// The lead of the best means over the next one that is not alike, as a share of the next; NaN if
/// that is 0 or there is none.
double lead_of(const ResultTable& table, std::span<const SummaryRow> rows,
               const std::vector<bool>& best, std::size_t column) {
  double winner = not_available, next = not_available;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!detail::is_comparable(table, rows[i], column)) continue;
    const double mean = rows[i].columns[column].mean;
    double& of = best[i] ? winner : next;
    const bool better = preference_of(table, table.columns[column].name) == Preference::less
                            ? mean < of
                            : mean > of;
    if (std::isnan(of) || better) of = mean;
  }
  return next == 0 ? not_available : std::abs(winner - next) / std::abs(next);
}

Table::Cell winner_cell(const ResultTable& table, std::span<const SummaryRow> rows,
                        std::size_t column) {
  const auto compared = std::count_if(rows.begin(), rows.end(), [&](const SummaryRow& row) {
    return detail::is_comparable(table, row, column);
  });
  if (compared < 2) return text_cell("–");
  const std::vector<bool> best = detail::best_of(table, rows, column);
  std::string names;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (best[i]) names += (names.empty() ? "" : ", ") + table.pipelines[rows[i].pipeline];
  }
  if (std::none_of(best.begin(), best.end(), [](bool one) { return one; }))
    return text_cell("all alike");
  Table::Cell cell = text_cell(std::move(names));
  const double lead = lead_of(table, rows, best, column);
  cell.share = 1;  // over 0 every lead is clear
  if (!std::isfinite(lead)) return cell;
  cell.text += fmt::format(" ({}\u00a0%)", shown(100 * lead, 3));
  cell.share = std::clamp(lead / clear_margin, 0.05, 1.0);
  return cell;
}

/// Which pipeline is best where.
void add_winners(const ResultTable& table, const Summary& summary,
                 const std::vector<Measure>& measures, const RunFiles& files, Report& report) {
  if (table.pipelines.size() < 2 || measures.empty()) return;
  Table winners;
  const std::vector<std::size_t> factors = factors_of(table);
  for (const std::size_t axis : factors) winners.header.push_back(table.axes[axis].name);
  for (const Measure& measure : measures) winners.header.push_back(measure.title);
  for (const std::span<const SummaryRow> rows : detail::combinations(summary)) {
    if (files.detail() == Detail::page && winners.rows.size() == most_rows) break;
    auto& cells = winners.rows.emplace_back();
    for (const std::size_t axis : factors) {
      cells.push_back(text_cell(detail::axis_value(table, axis, rows.front().at[axis])));
      cells.back().number = true;
    }
    for (const Measure& measure : measures)
      cells.push_back(winner_cell(table, rows, measure.column));
  }
  if (winners.rows.empty()) return;
  report.figures.push_back({"winners", section::comparison, "Which pipeline is best where",
                            "The pipeline with the best mean, or those whose best means are alike "
                            "up to 1e-9, and by how much they are better than "
                            "the next; the darker, the clearer. Only those are compared that have "
                            "a number at every repetition and whose estimates "
                            "never ended early.",
                            std::move(winners)});
}

/// The numbers of a column at one value of an axis, for one pipeline: over everything else.
struct Pool {
  std::vector<double> values;
  bool comparable = true;
};

std::vector<std::vector<Pool>> pools_of(const ResultTable& table, const Summary& summary,
                                        std::size_t axis, std::size_t column) {
  std::vector<std::vector<Pool>> pools(table.pipelines.size(),
                                       std::vector<Pool>(table.axes[axis].values.size()));
  for (const ResultRow& row : table.rows) {
    if (row.error.empty()) pools[row.pipeline][row.at[axis]].values.push_back(row.values[column]);
  }
  for (const SummaryRow& row : summary.rows) {
    if (!detail::is_comparable(table, row, column))
      pools[row.pipeline][row.at[axis]].comparable = false;
  }
  return pools;
}

/// The values of an axis as numbers, if all are.
std::optional<std::vector<double>> numbers_of_axis(const SweepAxis& axis) {
  if (!axis.labels.empty()) return std::nullopt;
  std::vector<double> numbers;
  for (const std::string& value : axis.values) {
    const detail::ParsedNumber parsed = detail::parse_number(value);
    if (!parsed.problem.empty()) return std::nullopt;
    numbers.push_back(parsed.value);
  }
  if (!std::is_sorted(numbers.begin(), numbers.end())) return std::nullopt;
  return numbers;
}

Plot curves_of(const ResultTable& table, const Summary& summary, std::size_t axis,
               const Measure& measure) {
  Plot plot{table.axes[axis].name, measure.title, false, {}};
  const auto numbers = numbers_of_axis(table.axes[axis]);
  if (!numbers) {
    for (std::size_t i = 0; i < table.axes[axis].values.size(); ++i)
      plot.x_names.push_back(detail::axis_value(table, axis, i));
  }
  const auto pools = pools_of(table, summary, axis, measure.column);
  double smallest = infinity, largest = 0;
  for (std::size_t p = 0; p < pools.size(); ++p) {
    const int pipeline = static_cast<int>(p);
    Series mean{Series::Kind::line, table.pipelines[p], pipeline, {}, {}};
    Series band{
        Series::Kind::band, "", pipeline, {}, {}};  // without an entry of its own in the legend
    bool any = false;
    for (std::size_t i = 0; i < pools[p].size(); ++i) {
      const Statistics found = statistics_of(pools[p][i].values);
      const bool known = pools[p][i].comparable && found.count > 0;
      mean.x.push_back(numbers ? (*numbers)[i] : static_cast<double>(i));
      mean.y.push_back(known ? found.mean : not_available);
      band.y.push_back(known ? found.q05 : not_available);
      band.upper.push_back(known ? found.q95 : not_available);
      any = any || known;
      if (!known) continue;
      smallest = std::min(smallest, found.q05);
      largest = std::max(largest, found.q95);
    }
    if (!any) continue;
    band.x = mean.x;
    plot.series.push_back(std::move(band));
    plot.series.push_back(std::move(mean));
  }
  plot.log_y = smallest > 0 && largest >= 100 * smallest;
  return plot;
}

/// What a figure's id may hold of a name.
std::string id_part(const std::string& name) {
  constexpr std::size_t longest = 60;
  std::string part;
  for (const char c : name.substr(0, longest)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (plain || (c >= 'A' && c <= 'Z')) {
      part += static_cast<char>(plain ? c : c - 'A' + 'a');
    } else if (!part.empty() && part.back() != '_') {
      part += '_';
    }
  }
  while (part.ends_with('_')) part.pop_back();
  return part;
}

/// By names, since places move when a column appears; numbered where names differ in nothing that
/// an id may hold.
std::string id_of(const std::string& axis, const std::string& column, const Report& report) {
  const std::string id = "sweep_" + id_part(axis) + "_" + id_part(column);
  const auto taken = [&](const std::string& one) {
    return std::any_of(report.figures.begin(), report.figures.end(),
                       [&](const Figure& figure) { return figure.id == one; });
  };
  if (!taken(id)) return id;
  int number = 2;
  while (taken(fmt::format("{}_{}", id, number))) ++number;
  return fmt::format("{}_{}", id, number);
}

/// The axes that numbers at one value of `axis` are taken over: "seed, order".
std::string others_of(const ResultTable& table, std::size_t axis) {
  std::string names;
  for (std::size_t i = 0; i < table.axes.size(); ++i) {
    if (i != axis && table.axes[i].values.size() > 1)
      names += (names.empty() ? "" : ", ") + table.axes[i].name;
  }
  return names;
}

void add_curves(const ResultTable& table, const Summary& summary,
                const std::vector<Measure>& measures, Report& report) {
  for (const std::size_t axis : factors_of(table)) {
    if (table.axes[axis].values.size() < 2) continue;
    const std::string others = others_of(table, axis);
    const std::string meaning =
        others.empty()
            ? "Lines join the numbers of single points."
            : "Lines: means, bands: 5 % to 95 % quantiles, over all values of " + others + ".";
    for (const Measure& measure : measures) {
      Plot plot = curves_of(table, summary, axis, measure);
      if (plot.series.empty()) continue;
      if (!others.empty()) plot.note = meaning;
      report.figures.push_back(
          {id_of(table.axes[axis].name, table.columns[measure.column].name, report), section::sweep,
           fmt::format("{} over {}", measure.title, table.axes[axis].name),
           meaning +
               " Gaps: a pipeline has failed, has no number, or its estimates ended early at some "
               "of them.",
           std::move(plot)});
    }
  }
}

void add_failed(const ResultTable& table, Report& report) {
  std::size_t failed = 0;
  const ResultRow* first = nullptr;
  for (const ResultRow& row : table.rows) {
    if (row.error.empty()) continue;
    if (failed++ == 0) first = &row;
  }
  if (!first) return;
  report.notes.push_back(fmt::format("{} of {} points failed; the first of \"{}\": {}", failed,
                                     table.rows.size(), table.pipelines[first->pipeline],
                                     first->error));
}

/// Names as they are printed.
ResultTable shown(ResultTable table) {
  table.title = detail::printable(table.title);
  for (std::string& name : table.pipelines) name = detail::printable(name);
  for (SweepAxis& axis : table.axes) {
    axis.name = detail::printable(axis.name);
    for (std::string& label : axis.labels) label = detail::printable(label);
  }
  for (ResultColumn& column : table.columns) column.name = detail::printable(column.name);
  for (ResultRow& row : table.rows) row.error = detail::printable_lines(row.error);
  return table;
}

}  // namespace

void add_comparisons(const RunFiles& files, Report& report) {
  ResultTable table = shown(read_result_table(files.directory()));
  if (files.detail() == Detail::all) table.sampling_time = 0;  // seconds are for people
  const Summary summary = summarise(table);
  const ComparisonTable comparison = comparison_table(table, summary);
  const std::vector<Measure> measures = measures_of(table, comparison);
  if (files.is_sweep()) {
    add_failed(table, report);
    add_winners(table, summary, measures, files, report);
  }
  add_comparison(comparison, files, report);
  if (files.is_sweep()) add_curves(table, summary, measures, report);
}

}  // namespace cordon::report
