// SPDX-License-Identifier: GPL-3.0-or-later
// Curves, bands and points over a common axis.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "page/svg_parts.hpp"

namespace cordon::report {

namespace {

/// Calls `draw` for each run of consecutive indices that have no gap.
template <class Draw>
void for_each_run(const Series& series, const Draw& draw) {
  const bool band = series.kind == Series::Kind::band;
  const auto has = [&](std::size_t i) {
    return std::isfinite(series.x[i]) && !std::isnan(series.y[i]) &&
           !(band && std::isnan(series.upper[i]));
  };
  for (std::size_t begin = 0; begin < series.x.size();) {
    std::size_t end = begin;
    while (end < series.x.size() && has(end)) ++end;
    if (end > begin) draw(begin, end);
    begin = end + 1;
  }
}

void draw_band(Drawing& drawing, const Series& series, const Frame& frame, std::size_t begin,
               std::size_t end) {
  std::vector<Point> lower, upper;
  for (std::size_t i = begin; i < end; ++i) {
    lower.emplace_back(frame.x(series.x[i]), frame.y(series.y[i]));
    upper.emplace_back(frame.x(series.x[i]), frame.y(series.upper[i]));
  }
  std::vector<Point> around = lower;
  around.insert(around.end(), upper.rbegin(), upper.rend());
  drawing.polygon(around, fmt::format("fill=\"{}\" fill-opacity=\"0.15\"",
                                      colour_of(series.pipeline, series.shade)));
  drawing.polyline(lower, stroke_of(series.pipeline, series.shade, 1.1));
  drawing.polyline(upper, stroke_of(series.pipeline, series.shade, 1.1));
}

bool has_squares(const Series& series) { return (series.pipeline / 8 + series.shade) % 2 != 0; }

void draw_points(Drawing& drawing, const Series& series, const Frame& frame, std::size_t begin,
                 std::size_t end) {
  const std::string fill = fmt::format("fill=\"{}\"", colour_of(series.pipeline, series.shade));
  for (std::size_t i = begin; i < end; ++i) {
    const Point at{frame.x(series.x[i]), frame.y(series.y[i])};
    if (!has_squares(series)) {
      drawing.circle(at, 3.2, fill);
    } else {
      drawing.rectangle({at.first - 3, at.second - 3}, 6, 6, fill);
    }
  }
}

void draw_line(Drawing& drawing, const Series& series, const Frame& frame, std::size_t begin,
               std::size_t end) {
  std::vector<Point> points;
  for (std::size_t i = begin; i < end; ++i) {
    const Point at{frame.x(series.x[i]), frame.y(series.y[i])};
    if (series.kind == Series::Kind::steps && !points.empty())
      points.emplace_back(at.first, points.back().second);
    points.push_back(at);
  }
  // Few values are seen as such.
  if (points.size() == 1 || (series.kind == Series::Kind::line && series.x.size() <= 12)) {
    for (const Point& point : points)
      drawing.circle(point, 2.5,
                     fmt::format("fill=\"{}\"", colour_of(series.pipeline, series.shade)));
  }
  if (points.size() > 1) drawing.polyline(points, stroke_of(series.pipeline, series.shade));
}

void draw_series(Drawing& drawing, const Series& series, const Frame& frame) {
  for_each_run(series, [&](std::size_t begin, std::size_t end) {
    if (series.kind == Series::Kind::band) return draw_band(drawing, series, frame, begin, end);
    if (series.kind == Series::Kind::points) return draw_points(drawing, series, frame, begin, end);
    draw_line(drawing, series, frame, begin, end);
  });
}

std::vector<LegendEntry> legend_of(const Plot& plot) {
  std::vector<LegendEntry> entries;
  for (const Series& series : plot.series) {
    if (series.name.empty()) continue;
    const std::string fill = fmt::format("fill=\"{}\"", colour_of(series.pipeline, series.shade));
    if (series.kind == Series::Kind::band) {
      entries.push_back(
          {LegendEntry::Kind::band, series.name,
           fill + " fill-opacity=\"0.15\" " + stroke_of(series.pipeline, series.shade, 1.1)});
    } else if (series.kind == Series::Kind::points) {
      entries.push_back(
          {has_squares(series) ? LegendEntry::Kind::squares : LegendEntry::Kind::points,
           series.name, fill});
    } else {
      entries.push_back(
          {LegendEntry::Kind::line, series.name, stroke_of(series.pipeline, series.shade)});
    }
  }
  return entries;
}

Axis x_axis(const Plot& plot, double begin, double end) {
  if (!plot.x_names.empty())
    return {-0.5, static_cast<double>(plot.x_names.size()) - 0.5, begin, end};
  double lower = INFINITY, upper = -INFINITY;
  bool single = false;
  for (const Series& series : plot.series) {
    single = single || series.kind == Series::Kind::points;
    for (const double x : series.x) {
      if (!std::isfinite(x)) continue;
      lower = std::min(lower, x);
      upper = std::max(upper, x);
    }
  }
  if (lower > upper) return {0, 1, begin, end};
  const double margin = lower == upper ? 0.5 : single ? 0.04 * (upper - lower) : 0;
  return {lower - margin, upper + margin, begin, end};
}

}  // namespace

std::string draw(const Plot& plot, const Figure& figure) {
  constexpr double width = 640, right = 626, height = 280;
  const double top = has_texts(plot.marks) ? 52 : 14, bottom = top + height;
  std::vector<double> values;
  bool whole = true;
  for (const Series& series : plot.series) {
    values.insert(values.end(), series.y.begin(), series.y.end());
    values.insert(values.end(), series.upper.begin(), series.upper.end());
    for (const double x : series.x) whole = whole && x == std::floor(x);
  }
  for (const auto& threshold : plot.thresholds) values.push_back(threshold.second);
  if (plot.range) values = {plot.range->first, plot.range->second};
  const Axis y_axis = axis_over(values, plot.log_y, bottom, top);
  const double left = room_beside(y_axis) + 8;
  const Frame frame{
      x_axis(plot, left, right), y_axis, plot.x_label, plot.y_label, plot.x_names, whole};
  std::vector<LegendEntry> legend = legend_of(plot);
  for (LegendEntry& entry : legend_of(plot.marks)) legend.push_back(std::move(entry));
  const double legend_top = bottom + 60;

  const double note_top = legend_top + draw_legend(nullptr, legend, left, right, legend_top);
  Drawing drawing(width, note_top + (plot.note.empty() ? 0 : 18), figure.title);
  draw_frame(drawing, frame);
  drawing.begin_clip({left, top}, right - left, bottom - top);
  for (const Series& series : plot.series) draw_series(drawing, series, frame);
  drawing.end_group();
  for (const auto& [name, value] : plot.thresholds) {
    if (!(value >= frame.y.lower && value <= frame.y.upper)) continue;
    const double y = frame.y(value);
    drawing.line({left, y}, {right, y},
                 "class=\"trace\" stroke=\"#1b2230\" stroke-dasharray=\"6 4\"");
    drawing.text({right - 4, y < top + 16 ? y + 13 : y - 4}, name,
                 at_end(ink) + std::string(halo) + " font-size=\"11\"");
  }
  draw_marks(drawing, plot.marks, frame.x, top, bottom);
  draw_legend(&drawing, legend, left, right, legend_top);
  if (!plot.note.empty()) drawing.text({left, note_top}, shortened(plot.note, right - left), soft);
  return drawing.str();
}

}  // namespace cordon::report
