// SPDX-License-Identifier: GPL-3.0-or-later
// Reports made by hand that hold every kind of figure.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "experiments/report/figure.hpp"

namespace sample {

using namespace cordon::report;

inline constexpr double missing = std::numeric_limits<double>::quiet_NaN();

inline Plot plot(int pipelines, std::size_t steps, bool log) {
  Plot plot{"k", "radius", log, {}};
  for (int p = 0; p < pipelines; ++p) {
    Series series{Series::Kind::line, "radius " + std::to_string(p + 1), p, {}, {}};
    for (std::size_t k = 0; k < steps; ++k) {
      series.x.push_back(static_cast<double>(k));
      const double base = 1 + 0.5 * std::sin(0.07 * static_cast<double>(k) + p) + p;
      series.y.push_back(log ? std::pow(10, base - 2) : base);
    }
    plot.series.push_back(series);
  }
  return plot;
}

inline Plot bands(int pipelines, std::size_t steps) {
  Plot plot{"k", "x1", false, {}};
  for (int p = 0; p < pipelines; ++p) {
    Series series{Series::Kind::band, "hull " + std::to_string(p + 1), p, {}, {}, {}};
    for (std::size_t k = 0; k < steps; ++k) {
      const double centre = 3 * std::sin(0.05 * static_cast<double>(k)),
                   half = 0.4 * (p + 1) + 0.1 * std::cos(0.3 * static_cast<double>(k));
      series.x.push_back(static_cast<double>(k));
      series.y.push_back(centre - half);
      series.upper.push_back(centre + half);
    }
    plot.series.push_back(series);
  }
  Series truth{Series::Kind::line, "true state", of_data, {}, {}};
  for (std::size_t k = 0; k < steps; ++k) {
    truth.x.push_back(static_cast<double>(k));
    truth.y.push_back(3 * std::sin(0.05 * static_cast<double>(k)));
  }
  plot.series.push_back(truth);
  return plot;
}

/// A hexagon around (cx, cy); `open`: its right side lies on the frame.
inline Polygon hexagon(int pipeline, double cx, double cy, double size, bool open = false) {
  Polygon polygon{pipeline, {}, {}};
  for (int i = 0; i < 6; ++i) {
    polygon.x.push_back(cx + size * std::cos(1.0471975512 * i + 0.5235987756));
    polygon.y.push_back(cy + size * std::sin(1.0471975512 * i + 0.5235987756));
  }
  if (open) polygon.open = {false, false, false, false, false, true};
  return polygon;
}

inline Projection projection() {
  Projection projection{"x1", "x2", {}};
  for (int k = 0; k < 12; ++k) {
    SetFrame frame{k, -5, 5, -4, 4, {}, std::pair{0.2 * k - 1, 0.1 * k}};
    frame.sets.push_back(hexagon(0, 0.2 * k - 1, 0.1 * k, 1.2));
    frame.sets.push_back(k < 6 ? hexagon(1, 0.2 * k - 1, 0.1 * k, 2.2, k == 0)
                               : Polygon{1, {}, {}});
    projection.frames.push_back(frame);
  }
  return projection;
}

inline Timeline timeline() {
  using State = Timeline::State;
  return {{"healthy", "valve is stuck", "leak"},
          {{0, 0, 20, State::monitored},
           {1, 0, 22, State::candidate},
           {2, 0, 60, State::candidate},
           {0, 21, 60, State::excluded},
           {1, 23, 60, State::monitored},
           {0, 0, 19, State::truth},
           {1, 20, 60, State::truth},
           {2, 40, 42, State::outside}},
          {{20, "fault begins"}, {21, "detected"}, {23, "isolated"}}};
}

inline Intervals intervals() {
  return {{{"model 1, model 2", "model 1", "model 2", -1.25, 0.5, 0.75, 3, "proven disjoint"},
           {"model 1, model 3", "model 1", "model 3", -cordon::infinity, 2, 1, 5, "overlap"}}};
}

inline Table table() {
  return {{"pipeline", "mean radius", "truth inside"},
          {{{"first"}, {"1.5", true, 1, true}, {"101/101", false, 0, true}},
           {{"second"}, {"2.25", false, 0.5, true}, {"101/101", false, 0, true}},
           {{"all"}, {"1.875", false, 0, true}, {"202/202", false, 0, true}}}};
}

inline Report every_kind() {
  Report report{"Every kind of figure",
                {"first", "second"},
                {"A note that comes first."},
                {},
                {{"cordon", "0.1.0"}, {"host", "a machine"}},
                "{\n  \"cordon\": 1\n}"};
  Plot curves = plot(2, 101, false);
  curves.thresholds = {{"bound", 1.85}};
  curves.marks = {{20, "fault begins"}, {26, "empty", 1}};
  curves.series[1].y[30] = missing;
  curves.series[1].y[31] = cordon::infinity;
  Plot steps = plot(2, 40, true);
  for (Series& series : steps.series) series.kind = Series::Kind::steps;
  steps.series[0].y[10] = 0;
  Plot points{"generators", "mean radius", false, {}};
  points.x_names = {"10", "20", "30"};
  points.series = {{Series::Kind::points, "first", 0, {0, 1, 2}, {3, 2, 1.5}},
                   {Series::Kind::points, "second", 1, {0, 1, 2}, {4, 3, 2.5}}};
  report.figures = {{"table", "Results", "Summary", "The best of each column is bold.", table()},
                    {"radius", "Sizes", "Radius", "Half the longest edge of the hull.", curves},
                    {"volume", "Sizes", "Volume", "", steps},
                    {"state_1", "States", "Bounds of x1", "", bands(2, 101)},
                    {"states", "States", "Sets", "Exact projections.", projection()},
                    {"budgets", "States", "Budgets", "", points},
                    {"modes", "Diagnosis", "Modes", "", timeline(), 1},
                    {"tubes", "Diagnosis", "Output tubes", "", intervals()}};
  return report;
}

/// Text that would do harm if it were taken for more than text.
inline const std::string hostile =
    "</script><script>alert(1)</script> \"quoted\" 'single' <b>&amp; {{data}} ünï — 推定 "
    "\xF0\x9F\x9B\xB0";

inline Report with_names(const std::string& name) {
  Report report = every_kind();
  report.title = name;
  report.pipelines = {name, name + " 2"};
  report.notes = {name};
  report.versions.emplace_back(name, name);
  report.study = name;
  for (Figure& figure : report.figures) {
    figure.title = figure.caption = figure.section = name;
    if (auto* plot = std::get_if<Plot>(&figure.content)) {
      plot->x_label = plot->y_label = name;
      for (Series& series : plot->series) series.name = name;
      for (Mark& mark : plot->marks) mark.text = name;
      for (auto& threshold : plot->thresholds) threshold.first = name;
      for (std::string& x_name : plot->x_names) x_name = name;
    } else if (auto* projection = std::get_if<Projection>(&figure.content)) {
      projection->x_label = projection->y_label = name;
    } else if (auto* timeline = std::get_if<Timeline>(&figure.content)) {
      for (std::string& row : timeline->rows) row = name;
      for (Mark& mark : timeline->marks) mark.text = name;
    } else if (auto* intervals = std::get_if<Intervals>(&figure.content)) {
      for (Intervals::Row& row : intervals->rows)
        row.name = row.first = row.second = row.verdict = name;
    } else if (auto* table = std::get_if<Table>(&figure.content)) {
      for (std::string& text : table->header) text = name;
      for (auto& row : table->rows) row[0].text = name;
    }
  }
  return report;
}

/// A state near a million that moves by thousandths.
inline Report far_from_origin() {
  Report report{"Far from the origin", {"first"}, {}, {}, {{"cordon", "0.1.0"}}, "{}"};
  Series series{Series::Kind::band, "hull", 0, {}, {}, {}};
  Projection sets{"x1", "x2", {}};
  for (int k = 0; k < 20; ++k) {
    const double centre = 1e6 + 1e-3 * std::sin(0.3 * k);
    series.x.push_back(k);
    series.y.push_back(centre - 2e-4);
    series.upper.push_back(centre + 2e-4);
    sets.frames.push_back(
        {k, 1e6 - 2e-3, 1e6 + 2e-3, -1e6 - 2e-3, -1e6 + 2e-3, {hexagon(0, centre, -1e6, 2e-4)}});
  }
  Plot plot{"k", "x1", false, {series}};
  report.figures.push_back({"far_state", "States", "Bounds of x1", "", plot});
  report.figures.push_back({"far_sets", "Sets", "Sets", "", sets});
  return report;
}

/// Ten pipelines over a thousand steps: bounds of six states, radius, volume and ten sets at a
/// hundred times.
inline Report large() {
  Report report{"Ten pipelines, a thousand steps", {}, {}, {}, {{"cordon", "0.1.0"}}, "{}"};
  for (int p = 0; p < 10; ++p) report.pipelines.push_back("pipeline " + std::to_string(p + 1));
  for (int i = 1; i <= 6; ++i)
    report.figures.push_back({"state_" + std::to_string(i), "States",
                              "Bounds of x" + std::to_string(i), "", bands(10, 1001)});
  report.figures.push_back({"radius", "Sizes", "Radius", "", plot(10, 1001, false)});
  report.figures.push_back({"volume", "Sizes", "Volume", "", plot(10, 1001, true)});
  Projection sets{"x1", "x2", {}};
  for (int k = 0; k < 100; ++k) {
    SetFrame frame{10 * k, -20, 20, -20, 20, {}};
    for (int p = 0; p < 10; ++p)
      frame.sets.push_back(hexagon(p, std::sin(0.1 * k), std::cos(0.1 * k), 1 + p));
    sets.frames.push_back(frame);
  }
  report.figures.push_back({"sets", "Sets", "Sets", "", sets});
  return report;
}

}  // namespace sample
