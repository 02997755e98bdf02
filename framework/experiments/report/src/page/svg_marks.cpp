// SPDX-License-Identifier: GPL-3.0-or-later
// What happens at some x of a figure.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "page/svg_parts.hpp"

namespace cordon::report {

namespace {

constexpr double beside_line = 3;  ///< from a line to a text at its side
constexpr double text_row = 13;

/// Where the text of a mark stands.
struct Place {
  enum class Side { over_line, left_of_line, right_of_line };
  double left = 0, right = 0;
  std::optional<std::size_t> row;  ///< from below; nothing: there is no room
  Side side = Side::over_line;
};

/// Places from left to right.
class Places {
 public:
  Places(const std::vector<Mark>& marks, const Axis& x) : marks_(marks), x_(x) {}

  std::vector<Place> all() {
    for (std::size_t i = 0; i < marks_.size(); ++i) {
      found_.push_back(place(i));
      if (found_.back().row) used_[*found_.back().row] = found_.back().right;
    }
    return std::move(found_);
  }

 private:
  double at(std::size_t i) const { return x_(marks_[i].x); }
  double width(std::size_t i) const { return text_width(marks_[i].text) + 8; }
  bool fits_right_of(std::size_t i) const { return at(i) + beside_line + width(i) <= x_.end + 8; }

  /// The first row that is free from there on.
  std::optional<std::size_t> row_from(double left) const {
    const auto row =
        std::find_if(used_.begin(), used_.end(), [&](double used) { return used <= left; });
    if (row == used_.end()) return std::nullopt;
    return static_cast<std::size_t>(row - used_.begin());
  }

  /// Would the texts of two lines that can be told apart cover each other, over their lines?
  bool is_near(std::size_t i, std::size_t next) const {
    if (next >= marks_.size()) return false;
    const double apart = at(next) - at(i);
    return apart > 0.5 && apart < (width(i) + width(next)) / 2;
  }

  Place place(std::size_t i) const {
    const double line = at(i);
    const bool after_left = i > 0 && found_[i - 1].side == Place::Side::left_of_line;
    if (after_left && fits_right_of(i)) {
      const double left = line + beside_line;
      return {left, left + width(i), found_[i - 1].row, Place::Side::right_of_line};
    }
    const double left = line - beside_line - width(i);
    if (is_near(i, i + 1) && left >= x_.begin - 40 && fits_right_of(i + 1)) {
      if (const auto row = row_from(left))
        return {left, line - beside_line, row, Place::Side::left_of_line};
    }
    const double half = width(i) / 2, least = x_.begin + half - 40;
    const double centre = std::clamp(line, least, std::max(least, x_.end - half + 8));
    return {centre - half, centre + half, row_from(centre - half)};
  }

  const std::vector<Mark>& marks_;
  const Axis& x_;
  std::array<double, 3> used_ = {-INFINITY, -INFINITY, -INFINITY};  ///< by row, up to where
  std::vector<Place> found_;
};

void draw_text(Drawing& drawing, const Mark& mark, const Place& place, double y) {
  const std::string fill =
      mark.pipeline == of_data ? std::string(soft) : "fill=\"" + colour_of(mark.pipeline) + "\"";
  const std::string over = std::string(halo) + " font-size=\"11\"";
  drawing.begin_group(owner(mark.pipeline) + "class=\"mark\"");
  switch (place.side) {
    case Place::Side::over_line:
      drawing.text({(place.left + place.right) / 2, y}, mark.text, at_middle(fill) + over);
      break;
    case Place::Side::left_of_line:
      drawing.text({place.right, y}, mark.text, at_end(fill) + over);
      break;
    case Place::Side::right_of_line:
      drawing.text({place.left, y}, mark.text, fill + over);
  }
  drawing.end_group();
}

void draw_lines(Drawing& drawing, const std::vector<Mark>& marks, const Axis& x, double top,
                double bottom) {
  const std::vector<Place> places = Places(marks, x).all();
  const auto above = [](const Place& place) {
    return place.row ? 6 + text_row * static_cast<double>(*place.row) : 0.0;
  };
  for (std::size_t i = 0; i < marks.size(); ++i) {
    drawing.begin_group(owner(marks[i].pipeline) + "class=\"mark\"");
    drawing.line(
        {x(marks[i].x), top - above(places[i])}, {x(marks[i].x), bottom},
        fmt::format("class=\"axis\" stroke=\"{}\" stroke-opacity=\"0.6\" stroke-dasharray=\"3 3\"",
                    colour_of(marks[i].pipeline)));
    drawing.end_group();
  }
  for (std::size_t i = 0; i < marks.size(); ++i) {  // above the lines of all of them
    if (places[i].row) draw_text(drawing, marks[i], places[i], top - above(places[i]) - 2);
  }
}

void draw_triangles(Drawing& drawing, const std::vector<Mark>& marks, const Axis& x,
                    double bottom) {
  std::vector<int> pipelines;
  for (const Mark& mark : marks) {
    auto found = std::find(pipelines.begin(), pipelines.end(), mark.pipeline);
    if (found == pipelines.end()) found = pipelines.insert(found, mark.pipeline);
    const double y = bottom - 8 * static_cast<double>(found - pipelines.begin()), at = x(mark.x);
    drawing.begin_group(owner(mark.pipeline) + "class=\"mark\"");
    drawing.polygon({{at - 4, y}, {at + 4, y}, {at, y - 8}},
                    "fill=\"" + colour_of(mark.pipeline) + "\"");
    drawing.end_group();
  }
}

}  // namespace

bool has_texts(const std::vector<Mark>& marks) {
  return std::any_of(marks.begin(), marks.end(), [](const Mark& mark) { return !mark.small; });
}

void draw_marks(Drawing& drawing, std::vector<Mark> marks, const Axis& x, double top,
                double bottom) {
  std::erase_if(marks, [&](const Mark& m) { return !(m.x >= x.lower && m.x <= x.upper); });
  std::vector<Mark> small;
  std::copy_if(marks.begin(), marks.end(), std::back_inserter(small),
               [](const Mark& mark) { return mark.small; });
  std::erase_if(marks, [](const Mark& mark) { return mark.small; });
  std::stable_sort(marks.begin(), marks.end(),
                   [](const Mark& a, const Mark& b) { return a.x < b.x; });
  draw_triangles(drawing, small, x, bottom);
  draw_lines(drawing, marks, x, top, bottom);
}

std::vector<LegendEntry> legend_of(const std::vector<Mark>& marks) {
  std::vector<LegendEntry> entries;
  std::vector<int> pipelines;  // by entry
  for (const Mark& mark : marks) {
    if (!mark.small) continue;
    const auto same = std::find_if(entries.begin(), entries.end(), [&](const LegendEntry& entry) {
      return entry.text == mark.text;
    });
    if (same == entries.end()) {
      pipelines.push_back(mark.pipeline);
      entries.push_back(
          {LegendEntry::Kind::triangle, mark.text, "fill=\"" + colour_of(mark.pipeline) + "\""});
    } else if (pipelines[static_cast<std::size_t>(same - entries.begin())] != mark.pipeline) {
      same->style = soft;
    }
  }
  return entries;
}

}  // namespace cordon::report
