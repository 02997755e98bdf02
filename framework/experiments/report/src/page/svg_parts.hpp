// SPDX-License-Identifier: GPL-3.0-or-later
// What the drawings of all kinds of figures share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiments/report/drawing.hpp"
#include "experiments/report/figure.hpp"
#include "experiments/report/ticks.hpp"

namespace cordon::report {

std::string draw(const Plot& plot, const Figure& figure);
std::string draw(const Projection& projection, const Figure& figure, const Report& report);
std::string draw(const Timeline& timeline, const Figure& figure);
std::string draw(const Intervals& intervals, const Figure& figure);
std::string draw(const Table& table, const Figure& figure);

/// Styles; their colours are those of white paper.
inline constexpr std::string_view ink = "class=\"ink\" fill=\"#1b2230\"";
inline constexpr std::string_view soft = "class=\"soft\" fill=\"#5a6475\"";
inline constexpr std::string_view rule = "class=\"rule\" stroke=\"#e1e5eb\"";
/// Of texts that lines may cross.
inline constexpr std::string_view halo =
    " stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\"";
inline constexpr std::string_view outline = "class=\"axis\" stroke=\"#8a94a5\"";

/// `style` with the text's end, or its middle, at the place.
std::string at_end(std::string_view style);
std::string at_middle(std::string_view style);

/// `data-pipeline`, so that a page can switch the element off; nothing for the data.
std::string owner(int pipeline);
/// Colour of a pipeline; later shades lie nearer to white.
std::string colour_of(int pipeline, int shade = 0);
/// stroke, its width and dashes.
std::string stroke_of(int pipeline, int shade = 0, double width = 1.6);

std::string_view name_of(Timeline::State state);

/// Frame, grid, ticks and labels around [x.begin, x.end] × [y.end, y.begin].
struct Frame {
  Axis x, y;
  std::string x_label, y_label;
  std::vector<std::string> x_names = {};  ///< words in place of numbers, at 0, 1, …
  bool whole_x = false;                   ///< ticks of x are integers
};
void draw_frame(Drawing& drawing, const Frame& frame);
/// What the ticks and the label of y take to the left of the frame.
double room_beside(const Axis& y);

/// Vertical lines with texts above `top`, in up to three rows of 13 units: two texts that would
/// cover each other stand on both sides of their lines, or in two rows; one without room is left
/// out. Small marks are triangles at `bottom`, those of every pipeline above those of the one
/// before.
void draw_marks(Drawing& drawing, std::vector<Mark> marks, const Axis& x, double top,
                double bottom);
/// Do any of them have texts above?
bool has_texts(const std::vector<Mark>& marks);

struct LegendEntry {
  enum class Kind { line, band, points, squares, fill, triangle };
  Kind kind = Kind::line;
  std::string text;
  std::string style;  ///< of what stands before the text
};
/// Of small marks, one per text.
std::vector<LegendEntry> legend_of(const std::vector<Mark>& marks);
/// Rows from `top` on, between `left` and `right`; returns their height. Without a drawing it only
/// measures.
double draw_legend(Drawing* drawing, const std::vector<LegendEntry>& entries, double left,
                   double right, double top);

}  // namespace cordon::report
