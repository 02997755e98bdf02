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

/// Up to six times, the first and the last at which there is something to see among them.
std::vector<const SetFrame*> chosen_times(const Projection& projection) {
  std::vector<const SetFrame*> seen;
  for (const SetFrame& time : projection.frames) {
    const bool any = std::any_of(time.sets.begin(), time.sets.end(),
                                 [](const Polygon& set) { return !set.x.empty(); });
    if (any) seen.push_back(&time);
  }
  if (seen.empty() && !projection.frames.empty()) seen.push_back(&projection.frames.back());
  const std::size_t count = std::min<std::size_t>(6, seen.size());
  std::vector<const SetFrame*> times;
  for (std::size_t i = 0; i < count; ++i)
    times.push_back(seen[count == 1 ? 0 : i * (seen.size() - 1) / (count - 1)]);
  return times;
}

/// The set of a pipeline at a time; nullptr if there is none.
const Polygon* set_of(const SetFrame& time, int pipeline) {
  const auto at = std::find_if(time.sets.begin(), time.sets.end(),
                               [&](const Polygon& set) { return set.pipeline == pipeline; });
  return at == time.sets.end() ? nullptr : &*at;
}

/// At which of the times drawn a pipeline's set is proven empty, and from when on it remains so.
std::string empty_times(const Projection& projection, const std::vector<const SetFrame*>& times,
                        int pipeline) {
  std::int64_t from = -1;
  for (const SetFrame& time : projection.frames) {
    const Polygon* set = set_of(time, pipeline);
    if (set == nullptr || !set->x.empty()) {
      from = -1;
    } else if (from < 0) {
      from = time.k;
    }
  }
  std::string told;
  for (const SetFrame* time : times) {
    const Polygon* set = set_of(*time, pipeline);
    if (set == nullptr || !set->x.empty() || (from >= 0 && time->k >= from)) continue;
    told += fmt::format("{}{}", told.empty() ? "at k = " : ", ", time->k);
  }
  if (from >= 0) told += fmt::format("{}from k = {} on", told.empty() ? "" : ", ", from);
  return told.empty() ? "" : " (proven empty " + told + ")";
}

/// What the pictures cannot show: sets that are proven empty, by name and time.
std::vector<LegendEntry> legend_of(const Projection& projection,
                                   const std::vector<const SetFrame*>& times,
                                   const Report& report) {
  std::vector<LegendEntry> entries;
  const bool truth =
      std::any_of(times.begin(), times.end(), [](const SetFrame* time) { return !!time->truth; });
  for (std::size_t i = 0; i < report.pipelines.size(); ++i) {
    const int pipeline = static_cast<int>(i);
    const bool present = std::any_of(times.begin(), times.end(), [&](const SetFrame* time) {
      return set_of(*time, pipeline) != nullptr;
    });
    if (present)
      entries.push_back({LegendEntry::Kind::line,
                         report.pipelines[i] + empty_times(projection, times, pipeline),
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
  const std::vector<LegendEntry> legend = legend_of(projection, times, report);
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
