// SPDX-License-Identifier: GPL-3.0-or-later
// Projections of sets: up to six times, side by side.
#include <algorithm>

#include <fmt/format.h>

#include "page/svg_parts.hpp"

namespace cordon::report {

namespace {

void draw_set(Drawing& drawing, const Polygon& set, const Axis& x, const Axis& y) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < set.x.size(); ++i) points.emplace_back(x(set.x[i]), y(set.y[i]));
  const std::string fill = fmt::format("fill=\"{}\"", colour_of(set.pipeline));
  if (points.size() == 1) drawing.circle(points[0], 3, fill);
  if (points.size() > 2) drawing.polygon(points, fill + " fill-opacity=\"0.13\"");
  const std::size_t edges = points.size() == 2 ? 1 : points.size() < 2 ? 0 : points.size();
  for (std::size_t i = 0; i < edges; ++i) {
    const bool open = i < set.open.size() && set.open[i];
    const std::string style =
        open ? fmt::format("stroke=\"{}\" stroke-width=\"2.4\" stroke-dasharray=\"1.5 4\"",
                           colour_of(set.pipeline))
             : stroke_of(set.pipeline);
    drawing.line(points[i], points[(i + 1) % points.size()], style + " stroke-linecap=\"round\"");
  }
}

/// One time in the square whose upper left corner is `corner`; true if a set continues beyond the
/// frame.
bool draw_time(Drawing& drawing, const Projection& projection, const SetFrame& time, Point corner,
               double size) {
  const Axis y{time.bottom, time.top, corner.second + size - 48, corner.second + 24};
  const Axis x{time.left, time.right, corner.first + room_beside(y), corner.first + size};
  drawing.text({x.begin, corner.second + 15},
               time.time.empty() ? fmt::format("k = {}", time.k) : time.time,
               std::string(ink) + " font-weight=\"bold\"");
  draw_frame(drawing, {x, y, projection.x_label, projection.y_label});
  drawing.begin_clip({x.begin - 2, y.end - 2}, x.end - x.begin + 4, y.begin - y.end + 4);
  bool open = false;
  for (const Polygon& set : time.sets) {
    draw_set(drawing, set, x, y);
    open = open || std::find(set.open.begin(), set.open.end(), true) != set.open.end();
  }
  if (time.truth)
    drawing.circle({x(time.truth->first), y(time.truth->second)}, 4,
                   "class=\"ink\" fill=\"#1b2230\" stroke=\"#ffffff\"");
  drawing.end_group();
  return open;
}

/// Up to six times, the first and the last among them.
std::vector<const SetFrame*> chosen_times(const Projection& projection) {
  const std::size_t count = std::min<std::size_t>(6, projection.frames.size());
  std::vector<const SetFrame*> times;
  for (std::size_t i = 0; i < count; ++i) {
    times.push_back(
        &projection.frames[count == 1 ? 0 : i * (projection.frames.size() - 1) / (count - 1)]);
  }
  return times;
}

/// What the pictures cannot show: sets that are proven empty, by name and time.
std::vector<LegendEntry> legend_of(const std::vector<const SetFrame*>& times,
                                   const Report& report) {
  std::vector<LegendEntry> entries;
  bool truth = false;
  for (std::size_t i = 0; i < report.pipelines.size(); ++i) {
    const int pipeline = static_cast<int>(i);
    std::string empty;
    bool present = false;
    for (const SetFrame* time : times) {
      truth = truth || time->truth.has_value();
      for (const Polygon& set : time->sets) {
        if (set.pipeline != pipeline) continue;
        present = true;
        if (set.x.empty())
          empty += fmt::format("{}{}", empty.empty() ? " (proven empty at k = " : ", ", time->k);
      }
    }
    if (present)
      entries.push_back({LegendEntry::Kind::line,
                         report.pipelines[i] + empty + (empty.empty() ? "" : ")"),
                         stroke_of(pipeline)});
  }
  if (truth)
    entries.push_back({LegendEntry::Kind::points, "true state", "class=\"ink\" fill=\"#1b2230\""});
  return entries;
}

}  // namespace

std::string draw(const Projection& projection, const Figure& figure, const Report& report) {
  constexpr double size = 300, gap = 24;
  const std::vector<const SetFrame*> times = chosen_times(projection);
  const std::size_t columns = std::clamp<std::size_t>(times.size() == 4 ? 2 : times.size(), 1, 3);
  const std::size_t rows = (times.size() + columns - 1) / columns;
  const double width = static_cast<double>(columns) * (size + gap),
               legend_top = static_cast<double>(rows) * (size + gap) + 20;
  const std::vector<LegendEntry> legend = legend_of(times, report);
  Drawing drawing(width, legend_top + draw_legend(nullptr, legend, 12, width - 12, legend_top) + 18,
                  figure.title);
  bool open = false;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const Point corner{static_cast<double>(i % columns) * (size + gap) + 6,
                       static_cast<double>(i / columns) * (size + gap)};
    open = draw_time(drawing, projection, *times[i], corner, size) || open;
  }
  const double below = legend_top + draw_legend(&drawing, legend, 12, width - 12, legend_top);
  if (open) drawing.text({12, below}, "Dotted edges: the set continues beyond the frame.", soft);
  return drawing.str();
}

}  // namespace cordon::report
