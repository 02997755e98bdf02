// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "figures/figures.hpp"

namespace cordon::report {

namespace {

bool has_inner(const Curves& curves) {
  return std::any_of(curves.pipelines.begin(), curves.pipelines.end(), [](const StepCurves& steps) {
    return std::any_of(steps.inner.begin(), steps.inner.end(),
                       [](const Thinner& curve) { return curve.has_values(); });
  });
}

void add_events(const Curves& curves, Plot& plot) {
  for (const PlantEvent& event : curves.events)
    plot.marks.push_back({static_cast<double>(event.k), event.text});
}

/// Where an estimate begins anew after it was empty, its first set may be very wide.
bool begins_anew(const Curves& curves) {
  return std::any_of(curves.pipelines.begin(), curves.pipelines.end(),
                     [](const StepCurves& steps) { return steps.empty_from.size() > 1; });
}

constexpr double much_wider = 20;

/// The range of what is no more than `much_wider` times as wide as the median; none if all is.
std::optional<std::pair<double, double>> range_but_for_wide_bands(const Plot& plot) {
  std::vector<double> widths;
  const auto width_at = [](const Series& series, std::size_t i) {
    return series.upper.empty() ? 0.0 : series.upper[i] - series.y[i];
  };
  for (const Series& series : plot.series) {
    for (std::size_t i = 0; i < series.upper.size(); ++i) {
      if (std::isfinite(width_at(series, i))) widths.push_back(width_at(series, i));
    }
  }
  if (widths.empty()) return std::nullopt;
  const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
  std::nth_element(widths.begin(), middle, widths.end());
  double lower = infinity, upper = -infinity;
  for (const Series& series : plot.series) {
    for (std::size_t i = 0; i < series.y.size(); ++i) {
      if (!(width_at(series, i) <= much_wider * *middle)) continue;
      lower = std::min(lower, series.y[i]);
      upper = std::max(upper, series.upper.empty() ? series.y[i] : series.upper[i]);
    }
  }
  if (!std::isfinite(upper - lower)) return std::nullopt;
  return std::pair(lower, upper);
}

Plot bounds_of(const RunFiles& files, const Curves& curves, std::size_t i) {
  Plot plot{"k", axis_of(files.labels().states, "x", i), false, {}};
  for (std::size_t p = 0; p < curves.pipelines.size(); ++p) {
    const StepCurves& steps = curves.pipelines[p];
    const std::string& name = files.pipelines()[p].name;
    const int pipeline = static_cast<int>(p);
    if (!steps.hull[i].is_empty()) plot.series.push_back(steps.hull[i].band(name, pipeline));
    if (i < steps.inner.size() && steps.inner[i].has_values()) {
      Series inner = steps.inner[i].band(name + ", inner", pipeline);
      inner.shade = 1;
      plot.series.push_back(std::move(inner));
    }
    if (steps.empty_from.empty()) continue;
    const std::int64_t k = steps.empty_from.front();
    const std::string when = time_text(files.labels(), k);
    plot.marks.push_back({static_cast<double>(k),
                          steps.empty_from.size() == 1 ? "empty from " + when
                                                       : fmt::format("empty {} times, first at {}",
                                                                     steps.empty_from.size(), when),
                          pipeline});
  }
  if (i < curves.truth.size() && curves.truth[i].has_values())
    plot.series.push_back(curves.truth[i].line("true state", of_data));
  add_events(curves, plot);
  if (begins_anew(curves)) plot.range = range_but_for_wide_bands(plot);
  return plot;
}

/// Beside a large state the bands of its bounds are too narrow to be seen.
Plot errors_of(const RunFiles& files, const Curves& curves, std::size_t i) {
  const std::string state = axis_of(files.labels().states, "x", i);
  Plot plot{"k", "bounds less " + state, false, {}, {{"true state", 0}}};
  for (std::size_t p = 0; p < curves.pipelines.size(); ++p) {
    const StepCurves& steps = curves.pipelines[p];
    if (i < steps.error.size() && steps.error[i].has_values())
      plot.series.push_back(steps.error[i].band(files.pipelines()[p].name, static_cast<int>(p)));
  }
  add_events(curves, plot);
  return plot;
}

Plot widths_of(const RunFiles& files, const Curves& curves, std::size_t i) {
  Plot plot{"k", "width of " + axis_of(files.labels().states, "x", i), false, {}};
  double smallest = infinity, largest = 0;
  for (std::size_t p = 0; p < curves.pipelines.size(); ++p) {
    const Thinner& width = curves.pipelines[p].width[i];
    if (!width.has_values()) continue;
    plot.series.push_back(width.line(files.pipelines()[p].name, static_cast<int>(p)));
    smallest = std::min(smallest, width.smallest());
    largest = std::max(largest, width.largest());
  }
  plot.log_y = is_logarithmic(smallest, largest);
  add_events(curves, plot);
  return plot;
}

/// Bands of the bounds, or of the bounds less the truth, where a transient hides them.
void add_steady_state(const std::string& id, const std::string& title, const RunFiles& files,
                      const Plot& bands, const Plot& widths, Report& report) {
  std::vector<const Series*> lines;
  for (const Series& series : widths.series) lines.push_back(&series);
  const auto from = end_of_transient(lines);
  if (!from) return;
  auto plot = hidden_after(bands, *from);
  if (!plot) return;
  report.figures.push_back(
      {id, section::bounds, title + " after the transient",
       fmt::format("From {} on: no width exceeds twice the largest one of its second half.",
                   time_text(files.labels(), static_cast<std::int64_t>(*from))),
       *std::move(plot)});
}

}  // namespace

void add_bounds(const RunFiles& files, const Curves& curves, Report& report) {
  if (std::none_of(curves.pipelines.begin(), curves.pipelines.end(),
                   [](const StepCurves& steps) { return steps.first >= 0; }))
    return;
  if (curves.states < curves.all_states) {
    report.notes.push_back(fmt::format("The first {} of {} states are drawn; steps.csv holds all.",
                                       curves.states, curves.all_states));
  }
  if (curves.thinned) {
    report.notes.push_back(
        "Curves are thinned out: bands show the smallest lower and the largest upper bound of "
        "neighbouring times, lines both "
        "extremes. "
        "steps.csv holds every number.");
  }
  std::string caption = "Bounds of the state, from the interval hull of every set.";
  if (!curves.truth.empty()) caption += " The line is the true state.";
  if (has_inner(curves))
    caption +=
        " Inner bands are reached by some trajectory: what lies between them and the bounds is the "
        "price of enclosing.";
  if (begins_anew(curves)) {
    caption += fmt::format(
        " What is more than {} times as wide as usual, as where an estimate begins anew, goes on "
        "beyond the frame.",
        much_wider);
  }
  std::vector<Figure> errors, widths;
  Report late;
  for (std::size_t i = 0; i < curves.states; ++i) {
    const std::string state = title_of(files.labels().states, "state", i);
    Plot band = bounds_of(files, curves, i), error = errors_of(files, curves, i),
         width = widths_of(files, curves, i);
    const std::string title = "Bounds of " + state, error_title = title + " less its true value";
    add_steady_state(fmt::format("steady_state_{}", i + 1),
                     error.series.empty() ? title : error_title, files,
                     error.series.empty() ? band : error, width, late);
    report.figures.push_back(
        {fmt::format("bounds_{}", i + 1), section::bounds, title, caption, std::move(band)});
    if (!error.series.empty()) {
      errors.push_back({fmt::format("bounds_less_truth_{}", i + 1), section::bounds, error_title,
                        "How far the bounds lie from the true state, which is 0 here: a band "
                        "that leaves 0 out does not hold it.",
                        std::move(error)});
    }
    if (!width.series.empty()) {
      widths.push_back({fmt::format("width_{}", i + 1), section::bounds,
                        "Width of the bounds of " + state,
                        "Upper less lower bound over time; none where the estimate is empty.",
                        std::move(width)});
    }
  }
  for (std::vector<Figure>* group : {&errors, &late.figures, &widths})
    std::move(group->begin(), group->end(), std::back_inserter(report.figures));
}

}  // namespace cordon::report
