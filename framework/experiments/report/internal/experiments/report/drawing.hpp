// SPDX-License-Identifier: GPL-3.0-or-later
// An SVG drawing, element by element.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cordon::report {

/// Text that may stand in HTML and XML, between tags and in quotes: what XML does not allow becomes
/// U+FFFD.
std::string escaped(std::string_view text);

/// About how wide a text is that is 12 units high.
double text_width(std::string_view text);

/// The text itself, or its beginning with … where it is wider than `width`.
std::string shortened(std::string_view text, double width);

using Point = std::pair<double, double>;

/// Coordinates are units of the drawing, y goes downwards. `style` is SVG as it is, never a text of
/// a study. Classes let a page give its own colours to what is not a pipeline's.
class Drawing {
 public:
  Drawing(double width, double height, std::string_view title);

  void line(Point from, Point to, std::string_view style);
  void rectangle(Point corner, double width, double height, std::string_view style);
  void circle(Point centre, double radius, std::string_view style);
  void polyline(const std::vector<Point>& points, std::string_view style);
  void polygon(const std::vector<Point>& points, std::string_view style);
  void text(Point place, std::string_view text, std::string_view style = "");
  void begin_group(std::string_view style);
  void end_group() { body_ += "</g>\n"; }
  /// What follows up to `end_group` is cut off outside the rectangle.
  void begin_clip(Point corner, double width, double height);

  std::string str() const;

 private:
  void points(std::string_view name, const std::vector<Point>& points, std::string_view style);

  double width_, height_;
  std::string title_, body_;
  int clips_ = 0;
};

}  // namespace cordon::report
