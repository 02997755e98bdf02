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

bool begins_anew(const Curves& curves) {
  return std::any_of(curves.pipelines.begin(), curves.pipelines.end(),
                     [](const StepCurves& steps) { return steps.times_anew > 0; });
}

void add_restarts(const Curves& curves, Plot& plot) {
  for (std::size_t p = 0; p < curves.pipelines.size(); ++p) {
    for (const std::int64_t k : curves.pipelines[p].anew)
      plot.marks.push_back({static_cast<double>(k), "begun anew", static_cast<int>(p), true});
  }
}

constexpr double much_wider = 20, usual_wider = 2;  ///< times the median of widths

double width_at(const Series& series, std::size_t i) {
  return series.upper.empty() ? 0.0 : series.upper[i] - series.y[i];
}

/// Of the finite ones; NaN if there are none.
double median(std::vector<double> widths) {
  std::erase_if(widths, [](double width) { return !std::isfinite(width); });
  if (widths.empty()) return not_available;
  const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
  std::nth_element(widths.begin(), middle, widths.end());
  return *middle;
}

std::vector<double> widths_of(const Series& series) {
  std::vector<double> widths;
  for (std::size_t i = 0; i < series.upper.size(); ++i) widths.push_back(width_at(series, i));
  return widths;
}

/// By point: does it lie between a time at which the estimate begins anew and the first at which
/// its band is not much wider than usual?
std::vector<bool> unsettled(const Series& band, const std::vector<std::int64_t>& anew) {
  std::vector<bool> found(band.x.size(), false);
  const double limit = usual_wider * median(widths_of(band));
  auto next = anew.begin();
  bool now = false;
  for (std::size_t i = 0; i < band.x.size(); ++i) {
    for (; next != anew.end() && static_cast<double>(*next) <= band.x[i]; ++next) now = true;
    if (width_at(band, i) <= limit) now = false;
    found[i] = now;
  }
  return found;
}

/// The range of the bands but for those of estimates that have just begun anew, and those more than
/// `much_wider` times as wide as the median of all; none if nothing is left.
std::optional<std::pair<double, double>> usual_range(const Curves& curves, const Plot& plot) {
  std::vector<double> widths;
  for (const Series& series : plot.series) {
    const std::vector<double> more = widths_of(series);
    widths.insert(widths.end(), more.begin(), more.end());
  }
  const double limit = much_wider * median(std::move(widths));
  double lower = infinity, upper = -infinity;
  for (const Series& series : plot.series) {
    std::vector<bool> left_out(series.x.size(), false);
    if (series.pipeline != of_data && series.kind == Series::Kind::band) {
      const auto p = static_cast<std::size_t>(series.pipeline);
      left_out = unsettled(series, curves.pipelines[p].anew);
    }
    for (std::size_t i = 0; i < series.y.size(); ++i) {
      if (left_out[i] || !(width_at(series, i) <= limit)) continue;
      lower = std::min(lower, series.y[i]);
      upper = std::max(upper, series.upper.empty() ? series.y[i] : series.upper[i]);
    }
  }
  if (!std::isfinite(upper - lower)) return std::nullopt;
  return std::pair(lower, upper);
}

/// What captions say of restarts.
std::string restarts_text(const RunFiles& files, const Curves& curves) {
  if (!begins_anew(curves)) return "";
  std::string text =
      " Triangles at the axis: an estimate begins anew after it was empty. Its first, wide bands "
      "go "
      "on beyond the frame.";
  for (std::size_t p = 0; p < curves.pipelines.size(); ++p) {
    const StepCurves& steps = curves.pipelines[p];
    if (steps.times_anew > static_cast<std::int64_t>(steps.anew.size())) {
      text += fmt::format(" \"{}\" does so {} times, of which the first {} are marked.",
                          files.pipelines()[p].name, steps.times_anew, steps.anew.size());
    }
  }
  return text;
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
  add_restarts(curves, plot);
  if (begins_anew(curves)) plot.range = usual_range(curves, plot);
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
  add_restarts(curves, plot);
  if (begins_anew(curves)) plot.range = usual_range(curves, plot);
  return plot;
}

Plot width_plot_of(const RunFiles& files, const Curves& curves, std::size_t i) {
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
  add_restarts(curves, plot);
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
  const std::string restarts = restarts_text(files, curves);
  caption += restarts;
  std::vector<Figure> errors, widths;
  Report late;
  for (std::size_t i = 0; i < curves.states; ++i) {
    const std::string state = title_of(files.labels().states, "state", i);
    Plot band = bounds_of(files, curves, i), error = errors_of(files, curves, i),
         width = width_plot_of(files, curves, i);
    const std::string title = "Bounds of " + state, error_title = title + " less its true value";
    add_steady_state(fmt::format("steady_state_{}", i + 1),
                     error.series.empty() ? title : error_title, files,
                     error.series.empty() ? band : error, width, late);
    report.figures.push_back(
        {fmt::format("bounds_{}", i + 1), section::bounds, title, caption, std::move(band)});
    if (!error.series.empty()) {
      errors.push_back({fmt::format("bounds_less_truth_{}", i + 1), section::bounds, error_title,
                        "How far the bounds lie from the true state, which is 0 here: a band that "
                        "leaves 0 out does not hold it." +
                            restarts,
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
