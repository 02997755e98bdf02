// SPDX-License-Identifier: GPL-3.0-or-later
// Which mode is in which state when, one row per mode.
#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "page/svg_parts.hpp"

namespace cordon::report {

namespace {

std::string_view style_of(Timeline::State state) {
  switch (state) {
    case Timeline::State::candidate:
      return "fill=\"#4ba3dc\" fill-opacity=\"0.55\"";
    case Timeline::State::monitored:
      return "fill=\"#0072b2\"";
    case Timeline::State::excluded:
      return "fill=\"#8a94a5\" fill-opacity=\"0.22\"";
    case Timeline::State::unconsidered:
      return "class=\"axis\" fill=\"none\" stroke=\"#8a94a5\" stroke-dasharray=\"2 4\"";
    case Timeline::State::outside:
      return "fill=\"#d55e00\"";
    case Timeline::State::truth:
      break;
  }
  return "class=\"ink\" fill=\"#1b2230\"";
}

}  // namespace

std::string draw(const Timeline& timeline, const Figure& figure) {
  constexpr double width = 960, right = 946, row_height = 30, most = 220;
  double names = 60;
  for (const std::string& row : timeline.rows)
    names = std::max(names, std::min(most, text_width(row)));
  const double left = names + 24, top = timeline.marks.empty() ? 12 : 52;
  const double bottom = top + row_height * static_cast<double>(timeline.rows.size());
  double first = INFINITY, last = -INFINITY;
  std::set<Timeline::State> states;
  for (const Timeline::Span& span : timeline.spans) {
    first = std::min(first, span.from);
    last = std::max(last, span.to);
    states.insert(span.state);
  }
  if (first > last) first = last = 0;
  const Axis x{first, last + timeline.step, left, right};  // a state holds until the next sample

  std::vector<LegendEntry> legend;
  for (const Timeline::State state : states) {
    legend.push_back(
        {LegendEntry::Kind::fill, std::string(name_of(state)), std::string(style_of(state))});
  }
  const double legend_top = bottom + 60;
  Drawing drawing(width, legend_top + draw_legend(nullptr, legend, left, right, legend_top),
                  figure.title);
  for (const double tick : x.ticks(10, timeline.step == 1)) {
    drawing.line({x(tick), top}, {x(tick), bottom}, rule);
    drawing.text({x(tick), bottom + 17}, short_text(tick), at_middle(soft));
  }
  drawing.text({(left + right) / 2, bottom + 36}, timeline.x_label, at_middle(ink));
  for (std::size_t i = 0; i < timeline.rows.size(); ++i) {
    const double y = top + row_height * static_cast<double>(i);
    drawing.text({left - 12, y + row_height / 2 + 4}, shortened(timeline.rows[i], most),
                 at_end(ink));
    drawing.line({left, y + row_height}, {right, y + row_height}, rule);
  }
  for (const Timeline::Span& span : timeline.spans) {
    const double y = top + row_height * static_cast<double>(span.row), from = x(span.from),
                 to = x(span.to + timeline.step);
    if (span.state == Timeline::State::truth) {
      drawing.rectangle({from, y + row_height - 8}, std::max(1.0, to - from), 4,
                        style_of(span.state));
    } else {
      drawing.rectangle({from, y + 5}, std::max(1.0, to - from), row_height - 15,
                        style_of(span.state));
    }
  }
  drawing.rectangle({left, top}, right - left, bottom - top, outline);
  draw_marks(drawing, timeline.marks, x, top, bottom);
  draw_legend(&drawing, legend, left, right, legend_top);
  return drawing.str();
}

}  // namespace cordon::report
