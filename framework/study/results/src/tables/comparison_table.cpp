// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/comparison_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "study/results/comparable.hpp"
#include "study/results/table_text.hpp"

namespace cordon {

namespace {

struct Measure {
  const char *name, *title;
  bool relative = false;
  bool percent = false;
  bool only_if_any = false;  ///< shown if one of the means is not 0
};

/// In the order of the table.
const std::vector<Measure>& measures() {
  static const std::vector<Measure> all{
      {"radius_mean", "mean radius", true},
      {"volume_mean", "mean volume", true},
      {"f_w_radius_mean", "mean F-W-radius", true},
      {"w_radius_mean", "mean W-radius", true},
      {"inner_share", "inner/outer width", false, true},
      {"radius_unbounded_steps", "unbounded steps", false, false, true},
      {"contains_truth_share", "truth inside", false, true},
      {"inconsistent", "empty steps", false, false, true},
      {"undecided", "undecided steps", false, false, true},
      {"detection_delay_median", "detection delay"},
      {"isolation_delay_median", "isolation delay"},
      {"false_alarm_rate", "false alarms", false, true},
      {"wrong_mode_rate", "wrong mode", false, true, true},
      {"missed_rate", "missed", false, true},
      {"faults_outside", "faults outside bounds", false, false, true},
      {"horizon", "horizon"},
      {"cost", "cost", true},
      {"gap", "gap", false, true},
      {"optimal", "optimal", false, true},
      {"infeasible", "infeasible", false, true, true},
      {"separates", "separates", false, true},
      {"kappa_min", "least κ"},
      {"experiments_isolated", "isolated"},
      {"experiments_wrong", "wrong", false, false, true},
      {"generators_max", "used generators"},
      {"constraints_max", "used constraints"},
      {"step_us", "µs/step", true},
      {"wall_s", "time [s]"},
  };
  return all;
}

/// A column of the table that is made of a column of the results.
struct Shown {
  Measure measure;
  std::size_t column;
};

bool is_half_width(const std::string& name) {
  return name.starts_with("fault_") && name.ends_with("_half_width");
}

/// Has the column a number in some row, and one that is worth a column?
bool is_worth(const Summary& summary, const Shown& shown) {
  return std::any_of(summary.rows.begin(), summary.rows.end(), [&](const SummaryRow& row) {
    const Statistics& found = row.columns[shown.column];
    return found.infinite > 0 ||
           (found.count > 0 && (!shown.measure.only_if_any || found.mean != 0));
  });
}

std::vector<Shown> shown_columns(const ResultTable& table, const Summary& summary) {
  std::vector<Shown> found;
  const auto add = [&](const Measure& measure, std::size_t column) {
    if (column < table.columns.size() && is_worth(summary, {measure, column}))
      found.push_back({measure, column});
  };
  for (const Measure& measure : measures()) {
    if (measure.name ==
        std::string_view("cost")) {  // before designs: what was bounded of additive faults
      for (std::size_t i = 0; i < table.columns.size(); ++i) {
        if (is_half_width(table.columns[i].name)) add({table.columns[i].name.c_str(), "", true}, i);
      }
    }
    add(measure, detail::column_of(table, measure.name));
  }
  const bool steps = std::any_of(found.begin(), found.end(), [](const Shown& s) {
    return s.measure.name == std::string_view("step_us");
  });
  const bool designs = detail::column_of(table, "cost") < table.columns.size();
  if (steps && !designs)
    std::erase_if(found,
                  [](const Shown& s) { return s.measure.name == std::string_view("wall_s"); });
  return found;
}

std::string title_of(const Shown& shown, const std::string& name) {
  if (*shown.measure.title) return shown.measure.title;
  return "half width " + name.substr(6, name.size() - 6 - std::string_view("_half_width").size());
}

/// "1.689 ± 0.012 (∞: 2) [40]": mean and deviation of the finite numbers; how many were infinite;
/// how many there are, if fewer than the points that did not fail.
std::string value_text(const SummaryRow& row, const Statistics& found, bool percent) {
  const double scale = percent ? 100 : 1;
  const std::int64_t finished = row.points - row.failed;
  if (found.count == 0) return found.infinite > 0 ? "∞" : "–";
  std::string text = number_text(scale * found.mean);
  if (found.deviation > 0) text += " ± " + number_text(scale * found.deviation, 2);
  if (percent) text += " %";
  if (found.infinite > 0) text += fmt::format(" (∞: {})", found.infinite);
  if (found.count + found.infinite < finished) text += fmt::format(" [{}]", found.count);
  return text;
}

bool any_row(const Summary& summary, const std::vector<Shown>& shown, auto&& holds) {
  return std::any_of(summary.rows.begin(), summary.rows.end(), [&](const SummaryRow& row) {
    return std::any_of(shown.begin(), shown.end(), [&](const Shown& s) { return holds(row, s); });
  });
}

std::vector<std::string> notes_of(const ResultTable& table, const Summary& summary,
                                  const std::vector<Shown>& shown) {
  std::vector<std::string> notes;
  std::int64_t most = 0;
  for (const SummaryRow& row : summary.rows) most = std::max(most, row.points);
  if (most > 1)
    notes.push_back(fmt::format("Mean ± standard deviation over up to {} repetitions.", most));
  const auto partial = [](const SummaryRow& row, const Shown& s) {
    const Statistics& found = row.columns[s.column];
    return found.count > 0 && found.count + found.infinite < row.points - row.failed;
  };
  if (any_row(summary, shown, partial))
    notes.emplace_back("[n]: only n points have such a number; the mean is over them.");
  const auto ended = [&](const SummaryRow& row, const Shown& s) {
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
  const std::vector<Shown> shown = shown_columns(table, summary);
  const bool failures = std::any_of(summary.rows.begin(), summary.rows.end(),
                                    [](const SummaryRow& row) { return row.failed > 0; });
  for (const Shown& s : shown) {
    const std::string& name = table.columns[s.column].name;
    result.columns.push_back({title_of(s, name), name, true, false});
    if (s.measure.relative && table.pipelines.size() > 1)
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
    for (const Shown& s : shown) {
      const std::vector<bool> best = detail::best_of(table, rows, s.column);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const Statistics& found = rows[i].columns[s.column];
        std::string text = value_text(rows[i], found, s.measure.percent);
        if (found.count == rows[i].points && !detail::is_comparable(table, rows[i], s.column))
          text += " †";
        result.rows[first + i].push_back({std::move(text), best[i]});
        if (s.measure.relative && table.pipelines.size() > 1)
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
