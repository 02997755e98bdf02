// SPDX-License-Identifier: GPL-3.0-or-later
#include "figure.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "fit.hpp"
#include "log_scale.hpp"

namespace cordon::bench {

namespace {

constexpr double panel_width = 320, panel_height = 300, left = 78, top = 84, gap = 34, right = 24,
                 below = 126;
constexpr double bottom = top + panel_height;

struct Style {
  const char* name;
  const char* color;
  const char* dash;
  const char* marker;  ///< SVG, around (0, 0)
};

/// Of the backends in their order; told apart in grey as well.
const Style& style(std::size_t backend) {
  static const Style styles[]{
      {"interval", "#595959", "2 3", R"(<circle r="3.5"/>)"},
      {"zonotope", "#0063a8", "", R"(<rect x="-3.3" y="-3.3" width="6.6" height="6.6"/>)"},
      {"constrained zonotope", "#b84300", "", R"(<path d="M0 -6.6L6 4.4H-6Z"/>)"},
      {"line zonotope", "#00735c", "6 4", R"(<path d="M0 -4.2L4.2 0L0 4.2L-4.2 0Z"/>)"},
  };
  return styles[backend % std::size(styles)];
}

enum class Anchor { start, middle, end };

std::string text(double x, double y, const std::string& words, Anchor anchor = Anchor::middle,
                 const char* more = "") {
  const char* anchors[]{"start", "middle", "end"};
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y,
                     anchors[static_cast<int>(anchor)], more, words);
}

std::string line(double x1, double y1, double x2, double y2, const char* color) {
  return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\"/>\n", x1, y1, x2, y2,
                     color);
}

/// 1 µs, 10 ms, …, for powers of ten.
std::string duration(double us) {
  if (us < .999) return fmt::format("{:.0f} ns", us * 1e3);
  if (us < 999) return fmt::format("{:.0f} µs", us);
  if (us < 999e3) return fmt::format("{:.0f} ms", us * 1e-3);
  return fmt::format("{:.0f} s", us * 1e-6);
}

struct Range {
  double low = infinity, high = 0;
  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// Whole powers of ten around the times of all panels.
Range time_range(const std::vector<AxisResult>& results) {
  Range times;
  for (const AxisResult& result : results) {
    for (const Curve& curve : result.curves) {
      for (const Measurement& m : curve.measurements) times.include(std::max(m.step, 1e-3));
    }
  }
  if (times.high == 0) return {1, 10};
  return {std::pow(10., std::floor(std::log10(times.low))),
          std::pow(10., std::ceil(std::log10(times.high)))};
}

std::string grid(const Axis& axis, double x0, const LogScale& x, const LogScale& y,
                 bool with_times) {
  const double x1 = x0 + panel_width;
  std::string svg;
  for (const double t : y.ticks({1})) {
    svg += line(x0, y(t), x1, y(t), "#d9d9d9");
    if (with_times) svg += text(x0 - 8, y(t) + 4, duration(t), Anchor::end);
  }
  for (const double t : y.ticks({2, 3, 4, 5, 6, 7, 8, 9}))
    svg += line(x0, y(t), x0 + 4, y(t), "#8c8c8c");
  for (const double t : x.ticks({1})) svg += line(x(t), top, x(t), bottom, "#d9d9d9");
  for (const double t : x.ticks({3, 4, 6, 7, 8, 9}))
    svg += line(x(t), bottom - 4, x(t), bottom, "#8c8c8c");
  for (const double t : x.ticks({1, 2, 5})) {
    svg += line(x(t), bottom - 6, x(t), bottom, "#595959");
    svg += text(x(t), bottom + 17, fmt::format("{:.0f}", t));
  }
  svg += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
      "stroke=\"#595959\"/>\n",
      x0, top, panel_width, panel_height);
  const double middle = x0 + panel_width / 2;
  svg += text(middle, bottom + 37, fmt::format("{} {}", axis.name, axis.symbol), Anchor::middle,
              " font-weight=\"bold\"");
  return svg + text(middle, bottom + 54, axis.held, Anchor::middle, " fill=\"#595959\"");
}

std::string curve_path(const Axis& axis, const Curve& curve, const Style& s, const LogScale& x,
                       const LogScale& y) {
  std::string path, markers;
  for (const Measurement& m : curve.measurements) {
    const double px = x(axis.at(m.budget)), py = y(std::max(m.step, 1e-3));
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px, py);
    markers += fmt::format("<g transform=\"translate({:.1f} {:.1f})\">{}</g>\n", px, py, s.marker);
  }
  if (path.empty()) return "";
  return fmt::format(
      "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\" "
      "stroke-dasharray=\"{}\"/>\n<g fill=\"{}\">{}</g>\n",
      path, s.color, *s.dash ? s.dash : "none", s.color, markers);
}

/// The exponents in two rows of two.
std::string exponents(const AxisResult& result, double x0) {
  std::string svg = text(x0, bottom + 80, "Time grows as", Anchor::start);
  for (std::size_t i = 0; i < result.curves.size(); ++i) {
    const std::string fitted = exponent_text(result.curves[i].time_exponent(result.axis));
    const std::string power =
        fmt::format("{}<tspan dy=\"-5\" font-size=\"10\">{}</tspan>", result.axis.symbol, fitted);
    const double x = x0 + static_cast<double>(i % 2) * panel_width * .57,
                 y = bottom + 98 + static_cast<double>(i / 2) * 18;
    svg += text(x, y, fmt::format("{}: {}", style(i).name, power), Anchor::start,
                fmt::format(" font-size=\"12\" fill=\"{}\"", style(i).color).c_str());
  }
  return svg;
}

std::string panel(const AxisResult& result, double x0, const Range& times, bool with_times) {
  const Axis& axis = result.axis;
  const LogScale x(axis.at(axis.cases.front()) / 1.2, axis.at(axis.cases.back()) * 1.2, x0,
                   x0 + panel_width);
  const LogScale y(times.low, times.high, bottom, top);
  std::string svg = grid(axis, x0, x, y, with_times);
  for (std::size_t i = 0; i < result.curves.size(); ++i)
    svg += curve_path(axis, result.curves[i], style(i), x, y);
  return svg + exponents(result, x0);
}

std::string legend(std::size_t backends) {
  std::string svg;
  double x = left;
  for (std::size_t i = 0; i < backends; ++i) {
    const Style& s = style(i);
    svg += fmt::format(
        "<path d=\"M{:.1f} 58h36\" stroke=\"{}\" stroke-width=\"1.8\" stroke-dasharray=\"{}\"/>\n"
        "<g fill=\"{}\" transform=\"translate({:.1f} 58)\">{}</g>\n",
        x, s.color, *s.dash ? s.dash : "none", s.color, x + 18, s.marker);
    svg += text(x + 44, 62, s.name, Anchor::start);
    x += 74 + 7.2 * static_cast<double>(std::string_view(s.name).size());
  }
  return svg;
}

}  // namespace

std::string figure(const std::vector<AxisResult>& results) {
  const auto panels = static_cast<double>(results.size());
  const double width = left + panels * panel_width + (panels - 1) * gap + right,
               height = bottom + below;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" "
      "font-family=\"Helvetica, Arial, sans-serif\" font-size=\"13\" fill=\"#1a1a1a\">\n"
      "<title>Time of a step against states, generators and constraints</title>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
      width, height);
  svg += text(left, 30, "Time of a step of prediction_correction in the steady state (median)",
              Anchor::start, " font-size=\"16\" font-weight=\"bold\"");
  svg += legend(results.empty() ? 0 : results.front().curves.size());
  const Range times = time_range(results);
  for (std::size_t i = 0; i < results.size(); ++i) {
    svg += panel(results[i], left + static_cast<double>(i) * (panel_width + gap), times, i == 0);
  }
  return svg + "</svg>\n";
}

}  // namespace cordon::bench
