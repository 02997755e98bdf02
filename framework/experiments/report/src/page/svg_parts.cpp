// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/svg_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "page/palette.hpp"

namespace cordon::report {

std::string at_end(std::string_view style) { return std::string(style) + " text-anchor=\"end\""; }

std::string at_middle(std::string_view style) {
  return std::string(style) + " text-anchor=\"middle\"";
}

std::string owner(int pipeline) {
  return pipeline == of_data ? "" : fmt::format("data-pipeline=\"{}\" ", pipeline);
}

std::string colour_of(int pipeline, int shade) {
  const std::string_view base =
      pipeline == of_data ? "#1b2230"
                          : on_white[static_cast<std::size_t>(pipeline) % on_white.size()];
  const double share = std::min(0.6, 0.22 * shade);
  std::string out = "#";
  for (std::size_t i = 1; i < 7; i += 2) {
    const double channel = std::stoi(std::string(base.substr(i, 2)), nullptr, 16);
    out += fmt::format("{:02x}", static_cast<int>(std::round(channel + (255 - channel) * share)));
  }
  return out;
}

std::string stroke_of(int pipeline, int shade, double width) {
  constexpr std::array<std::string_view, 5> dashes = {"", "7 4", "2 3", "9 3 2 3", "14 4"};
  const int turn = shade + (pipeline == of_data ? 0 : pipeline / static_cast<int>(on_white.size()));
  const std::string_view dash = dashes[static_cast<std::size_t>(turn) % dashes.size()];
  std::string style =
      fmt::format("stroke=\"{}\" stroke-width=\"{}\"", colour_of(pipeline, shade), width);
  if (pipeline == of_data && shade == 0) style += " class=\"trace\"";
  if (!dash.empty()) style += fmt::format(" stroke-dasharray=\"{}\"", dash);
  return style;
}

std::string_view name_of(Timeline::State state) {
  switch (state) {
    case Timeline::State::candidate:
      return "possible";
    case Timeline::State::monitored:
      return "monitored";
    case Timeline::State::excluded:
      return "excluded";
    case Timeline::State::unconsidered:
      return "not considered";
    case Timeline::State::truth:
      return "true mode";
    case Timeline::State::outside:
      break;
  }
  return "outside";
}

namespace {

std::vector<double> ticks_of_y(const Axis& y) {
  return y.upright(static_cast<int>((y.begin - y.end) / 45));
}

/// Of the text of a tick of x: that of the tick, but where the text would leave the drawing.
double centre_below(const Axis& x, double tick, const std::string& text) {
  return std::min(x(tick), x.end + 13 - text_width(text) / 2);
}

/// Do the texts of these ticks have room beside each other?
bool have_room(const Axis& x, const std::vector<double>& ticks) {
  double end = -INFINITY;  // of the text before
  for (const double tick : ticks) {
    const std::string text = x.text(tick);
    const double centre = centre_below(x, tick, text), half = text_width(text) / 2;
    if (centre - half < end + 10) return false;
    end = centre + half;
  }
  return true;
}

/// About one in 70 units, fewer where texts are long, and three if there is room for them.
std::vector<double> ticks_of_x(const Axis& x, bool whole) {
  int count = std::max(1, static_cast<int>((x.end - x.begin) / 70));
  std::vector<double> ticks = x.ticks(count, whole);
  while (count > 1 && !have_room(x, ticks)) ticks = x.ticks(--count, whole);
  const std::vector<double> closer = x.ticks(2 * count, whole);
  return ticks.size() < 3 && have_room(x, closer) ? closer : ticks;
}

}  // namespace

double room_beside(const Axis& y) {
  double widest = 27;
  for (const double tick : ticks_of_y(y)) widest = std::max(widest, text_width(y.text(tick)));
  return widest + 31;
}

void draw_frame(Drawing& drawing, const Frame& frame) {
  const Axis &x = frame.x, &y = frame.y;
  const double bottom = y.begin;
  std::vector<double> x_ticks;
  if (frame.x_names.empty()) {
    x_ticks = ticks_of_x(x, frame.whole_x);
  } else {
    for (std::size_t i = 0; i < frame.x_names.size(); ++i)
      x_ticks.push_back(static_cast<double>(i));
  }
  const double room =
      (x.end - x.begin) / static_cast<double>(std::max<std::size_t>(1, frame.x_names.size())) - 6;
  for (const double tick : x_ticks) {
    const std::string text = frame.x_names.empty()
                                 ? x.text(tick)
                                 : shortened(frame.x_names[static_cast<std::size_t>(tick)], room);
    drawing.line({x(tick), y.end}, {x(tick), bottom}, rule);
    drawing.text({centre_below(x, tick, text), bottom + 17}, text, at_middle(soft));
  }
  for (const double tick : ticks_of_y(y)) {
    drawing.line({x.begin, y(tick)}, {x.end, y(tick)}, rule);
    drawing.text({x.begin - 7, y(tick) + 4}, y.text(tick), at_end(soft));
  }
  drawing.rectangle({x.begin, y.end}, x.end - x.begin, bottom - y.end, outline);
  drawing.text({(x.begin + x.end) / 2, bottom + 36}, frame.x_label, at_middle(ink));
  const double middle = (y.begin + y.end) / 2;
  const double beside = x.begin - room_beside(y) + 10;
  drawing.text({beside, middle}, frame.y_label,
               at_middle(ink) + fmt::format(" transform=\"rotate(-90 {} {})\"", beside, middle));
}

double draw_legend(Drawing* drawing, const std::vector<LegendEntry>& entries, double left,
                   double right, double top) {
  double x = left, y = top;
  for (const LegendEntry& entry : entries) {
    const std::string text = shortened(entry.text, right - left - 40);
    const double width = 32 + text_width(text) + 18;
    if (x > left && x + width > right + 18) {
      x = left;
      y += 18;
    }
    if (drawing != nullptr) {
      if (entry.kind == LegendEntry::Kind::line)
        drawing->line({x, y - 4}, {x + 24, y - 4}, entry.style);
      if (entry.kind == LegendEntry::Kind::triangle)
        drawing->polygon({{x + 8, y}, {x + 16, y}, {x + 12, y - 8}}, entry.style);
      if (entry.kind == LegendEntry::Kind::squares)
        drawing->rectangle({x + 9, y - 7}, 6, 6, entry.style);
      if (entry.kind == LegendEntry::Kind::points)
        drawing->circle({x + 12, y - 4}, 3.5, entry.style);
      if (entry.kind == LegendEntry::Kind::band || entry.kind == LegendEntry::Kind::fill) {
        drawing->rectangle({x, y - 9}, 24, 10, entry.style);
      }
      drawing->text({x + 30, y}, text, ink);
    }
    x += width;
  }
  return entries.empty() ? 0 : y - top + 18;
}

}  // namespace cordon::report
