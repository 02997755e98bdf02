// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

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
    for (const std::int64_t k : steps.empty_from) {
      plot.marks.push_back(
          {static_cast<double>(k), "empty from " + time_text(files.labels(), k), pipeline});
    }
  }
  if (i < curves.truth.size() && curves.truth[i].has_values())
    plot.series.push_back(curves.truth[i].line("true state", of_data));
  for (const PlantEvent& event : curves.events)
    plot.marks.push_back({static_cast<double>(event.k), event.text});
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
  for (const PlantEvent& event : curves.events)
    plot.marks.push_back({static_cast<double>(event.k), event.text});
  return plot;
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
  for (std::size_t i = 0; i < curves.states; ++i) {
    report.figures.push_back({fmt::format("bounds_{}", i + 1), section::bounds,
                              "Bounds of " + title_of(files.labels().states, "state", i), caption,
                              bounds_of(files, curves, i)});
  }
  for (std::size_t i = 0; i < curves.states; ++i) {
    Plot plot = errors_of(files, curves, i);
    if (plot.series.empty()) continue;
    report.figures.push_back(
        {fmt::format("bounds_less_truth_{}", i + 1), section::bounds,
         "Bounds of " + title_of(files.labels().states, "state", i) + " less its true value",
         "How far the bounds lie from the true state, which is 0 here: a band "
         "that leaves 0 out does not hold it.",
         std::move(plot)});
  }
}

}  // namespace cordon::report
