// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of intervals that must not overlap, each pair on a scale of its own.
#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "page/svg_parts.hpp"

namespace cordon::report {

namespace {

struct Bar {
  const std::string& name;
  double lower, upper;
  std::string_view colour;
};

/// One interval with its ends in numbers, above or below it; those that are infinite go to the
/// edge.
void draw_bar(Drawing& drawing, const Bar& bar, const Axis& x, double y, double text_y) {
  const std::string style = std::string(soft) + " font-size=\"11\"";
  if (std::isnan(bar.lower) || std::isnan(bar.upper)) {
    drawing.text({x.begin, text_y}, bar.name + ": not known", style);
    return;
  }
  const double from = std::clamp(x(bar.lower), x.begin, x.end),
               to = std::clamp(x(bar.upper), x.begin, x.end);
  drawing.rectangle({from, y}, std::max(2.0, to - from), 10,
                    fmt::format("fill=\"{}\"", bar.colour));
  const std::string text =
      fmt::format("{}  [{}, {}]", bar.name, x.text(bar.lower), x.text(bar.upper));
  if (from + text_width(text) <= x.end) {
    drawing.text({from, text_y}, text, style);
  } else {
    drawing.text({to, text_y}, text, at_end(style));
  }
}

}  // namespace

std::string draw(const Intervals& intervals, const Figure& figure) {
  constexpr double width = 960, row_height = 76, most = 220;
  double names = 60, verdicts = 60;
  for (const Intervals::Row& row : intervals.rows) {
    names = std::max(names, std::min(most, text_width(row.name)));
    verdicts = std::max(verdicts, std::min(most, text_width(row.verdict)));
  }
  const double left = names + 28, right = width - verdicts - 28;
  Drawing drawing(width, row_height * static_cast<double>(intervals.rows.size()) + 12,
                  figure.title);
  double y = 6;
  for (const Intervals::Row& row : intervals.rows) {
    const Axis x = axis_over({row.first_lower, row.first_upper, row.second_lower, row.second_upper},
                             false, left, right);
    drawing.text({left - 16, y + row_height / 2 + 4}, shortened(row.name, most), at_end(ink));
    // The gap between them, if there is one.
    const double gap_from = std::min(row.first_upper, row.second_upper),
                 gap_to = std::max(row.first_lower, row.second_lower);
    if (gap_from < gap_to) {
      drawing.rectangle({x(gap_from), y + 22}, x(gap_to) - x(gap_from), 28,
                        "fill=\"#009e73\" fill-opacity=\"0.16\"");
    }
    draw_bar(drawing, {row.first, row.first_lower, row.first_upper, "#0072b2"}, x, y + 22, y + 17);
    draw_bar(drawing, {row.second, row.second_lower, row.second_upper, "#d55e00"}, x, y + 40,
             y + 63);
    drawing.text({width - 6, y + row_height / 2 + 4}, shortened(row.verdict, most), at_end(ink));
    drawing.line({left, y + row_height}, {right, y + row_height}, rule);
    y += row_height;
  }
  return drawing.str();
}

}  // namespace cordon::report
