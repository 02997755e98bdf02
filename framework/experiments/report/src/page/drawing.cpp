// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/drawing.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/text.hpp"

namespace cordon::report {

namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";

/// One well-formed character, as XML wants it.
std::string_view character(std::string_view c) {
  if (c == "&") return "&amp;";
  if (c == "<") return "&lt;";
  if (c == ">") return "&gt;";
  if (c == "\"") return "&quot;";
  if (c == "'") return "&#39;";
  const bool control =
      c.size() == 1 && static_cast<unsigned char>(c[0]) < 0x20 && c != "\n" && c != "\t";
  return control || c == "\xEF\xBF\xBE" || c == "\xEF\xBF\xBF" ? replacement : c;
}

/// Calls `visit` with each character; what is no UTF-8 comes as U+FFFD.
template <class Visit>
void for_each_character(std::string_view text, const Visit& visit) {
  while (!text.empty()) {
    const std::size_t length = detail::utf8_length(text);
    visit(length == 0 ? replacement : text.substr(0, length));
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
}

double width_of(std::string_view c) {
  if (c.size() > 1) return c.size() > 2 && static_cast<unsigned char>(c[0]) >= 0xE3 ? 12 : 7.2;
  if (std::string_view("il.,:;'|!()[] ftj").find(c) != std::string_view::npos) return 3.8;
  if (std::string_view("mwMW@%").find(c) != std::string_view::npos) return 10.2;
  return c[0] >= 'A' && c[0] <= 'Z' ? 8.4 : 6.7;
}

/// Places of a drawing, in hundredths.
std::string place(double value) {
  const std::string text = fmt::format("{:.2f}", value);
  const std::size_t last = text.find_last_not_of('0');
  const std::string out = text.substr(0, text[last] == '.' ? last : last + 1);
  return out == "-0" ? "0" : out;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  for_each_character(text, [&](std::string_view c) { out += character(c); });
  return out;
}

double text_width(std::string_view text) {
  double width = 0;
  for_each_character(text, [&](std::string_view c) { width += width_of(c); });
  return width;
}

std::string shortened(std::string_view text, double width) {
  if (text_width(text) <= width) return std::string(text);
  std::string out;
  double used = width_of("…");
  bool full = false;
  for_each_character(text, [&](std::string_view c) {
    used += width_of(c);
    full = full || used > width;
    if (!full) out += c;
  });
  return out + "…";
}

Drawing::Drawing(double width, double height, std::string_view title)
    : width_(width), height_(height), title_(title) {}

void Drawing::line(Point from, Point to, std::string_view style) {
  body_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" {}/>\n", place(from.first),
                       place(from.second), place(to.first), place(to.second), style);
}

void Drawing::rectangle(Point corner, double width, double height, std::string_view style) {
  body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {}/>\n",
                       place(corner.first), place(corner.second), place(std::max(0.0, width)),
                       place(std::max(0.0, height)), style);
}

void Drawing::circle(Point centre, double radius, std::string_view style) {
  body_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n", place(centre.first),
                       place(centre.second), place(radius), style);
}

void Drawing::points(std::string_view name, const std::vector<Point>& points,
                     std::string_view style) {
  body_ += fmt::format("<{} points=\"", name);
  for (std::size_t i = 0; i < points.size(); ++i) {
    body_ +=
        fmt::format("{}{},{}", i > 0 ? " " : "", place(points[i].first), place(points[i].second));
  }
  body_ += fmt::format("\" {}/>\n", style);
}

void Drawing::polyline(const std::vector<Point>& points, std::string_view style) {
  this->points("polyline", points, style);
}

void Drawing::polygon(const std::vector<Point>& points, std::string_view style) {
  this->points("polygon", points, style);
}

void Drawing::text(Point at, std::string_view text, std::string_view style) {
  body_ += fmt::format("<text x=\"{}\" y=\"{}\" {}>{}</text>\n", place(at.first), place(at.second),
                       style, escaped(text));
}

void Drawing::begin_group(std::string_view style) { body_ += fmt::format("<g {}>\n", style); }

void Drawing::begin_clip(Point corner, double width, double height) {
  const std::string id = "frame_" + std::to_string(++clips_);
  body_ += "<clipPath id=\"" + id + "\">";
  rectangle(corner, width, height, "");
  body_ += "</clipPath>\n";
  begin_group("clip-path=\"url(#" + id + ")\"");
}

std::string Drawing::str() const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" role=\"img\" "
      "font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" font-size=\"12\" "
      "fill=\"none\">\n<title>{2}</title>\n"
      "<rect class=\"paper\" width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n{3}</svg>\n",
      place(width_), place(height_), escaped(title_), body_);
}

}  // namespace cordon::report
