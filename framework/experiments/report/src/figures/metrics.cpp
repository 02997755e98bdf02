// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "experiments/report/ticks.hpp"
#include "figures/figures.hpp"
#include "study/results/measures.hpp"

namespace cordon::report {

namespace {

struct Curve {
  const Thinner* values = nullptr;
  int pipeline = of_data;
};

Plot plot_of(const RunFiles& files, const std::vector<Curve>& curves, const std::string& y_label) {
  Plot plot{"k", y_label, false, {}};
  double smallest = infinity, largest = 0;
  for (const auto& [values, pipeline] : curves) {
    if (!values->has_values()) continue;
    plot.series.push_back(
        values->line(files.pipelines()[static_cast<std::size_t>(pipeline)].name, pipeline));
    smallest = std::min(smallest, values->smallest());
    largest = std::max(largest, values->largest());
  }
  plot.log_y = is_logarithmic(smallest, largest);
  return plot;
}

/// "radius_mean" as "Radius mean".
std::string title_of(const std::string& column) {
  std::string title = column;
  std::replace(title.begin(), title.end(), '_', ' ');
  if (!title.empty() && title[0] >= 'a' && title[0] <= 'z')
    title[0] = static_cast<char>(title[0] - 'a' + 'A');
  return title;
}

/// Of all states; empty: they have none, or not the same.
std::string common_unit(const Labels::Names& states) {
  const std::string unit = states.empty() ? "" : unit_of(states.front());
  const bool same = std::all_of(states.begin(), states.end(),
                                [&](const std::string& state) { return unit_of(state) == unit; });
  return same ? unit : "";
}

/// "m³", "(m/s)²".
std::string power_of(const std::string& unit, std::size_t exponent) {
  if (exponent == 1) return unit;
  const bool simple = std::all_of(unit.begin(), unit.end(), [](unsigned char c) {
    return c >= 0x80 || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
  });
  return (simple ? unit : "(" + unit + ")") + superscript(static_cast<int>(exponent));
}

/// The metric's name with its unit: what the metric tells of numbers that sum the column up.
std::string labelled(const RunFiles& files, const Curves& curves, const std::string& column) {
  using Quantity = Measure::Quantity;
  const std::vector<Measure> measures = detail::read_measures(files.root());
  const auto measure = std::find_if(measures.begin(), measures.end(),
                                    [&](const Measure& m) { return m.of == column; });
  if (measure == measures.end()) return column;
  if (!measure->unit.empty()) return column + " [" + measure->unit + "]";
  const std::string unit = common_unit(files.labels().states);
  if (unit.empty() || measure->quantity == Quantity::number) return column;
  const std::size_t power = measure->quantity == Quantity::length           ? 1
                            : measure->quantity == Quantity::squared_length ? 2
                                                                            : curves.all_states;
  return column + " [" + power_of(unit, power) + "]";
}

void add(Report& report, std::string id, std::string title, std::string caption, Plot plot) {
  if (plot.series.empty()) return;
  report.figures.push_back(
      {std::move(id), section::metrics, std::move(title), std::move(caption), std::move(plot)});
}

}  // namespace

void add_metrics(const RunFiles& files, const Curves& curves, Report& report) {
  for (std::size_t i = 0; i < curves.metrics.size(); ++i) {
    std::vector<Curve> values;
    for (std::size_t p = 0; p < curves.pipelines.size(); ++p) {
      values.push_back({&curves.pipelines[p].metrics[i], static_cast<int>(p)});
    }
    Plot plot = plot_of(files, values, labelled(files, curves, curves.metrics[i]));
    for (const PlantEvent& event : curves.events)
      plot.marks.push_back({static_cast<double>(event.k), event.text});
    add(report, fmt::format("metric_{}", i + 1), title_of(curves.metrics[i]),
        fmt::format("The metric {} over time.", curves.metrics[i]), std::move(plot));
  }
  std::vector<Curve> times;
  for (std::size_t p = 0; p < files.step_times().size(); ++p)
    times.push_back({&files.step_times()[p], static_cast<int>(p)});
  add(report, "step_time", "Time of a step",
      "Measured on the machine of this run: it differs from run to run.",
      plot_of(files, times, "time per step [µs]"));
}

}  // namespace cordon::report
