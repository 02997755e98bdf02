// SPDX-License-Identifier: GPL-3.0-or-later
// Figures as SVG files: which drawing is of which kind, and those that are a few rows of text.
#include "experiments/report/svg.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "page/svg_parts.hpp"

namespace cordon::report {

std::string draw(const Table& table, const Figure& figure) {
  constexpr double row_height = 24, gap = 22, most = 320;
  std::vector<double> widths;
  const auto widen = [&](std::size_t column, const std::string& text) {
    if (column >= widths.size()) widths.resize(column + 1, 0);
    widths[column] = std::max(widths[column], std::min(most, 1.08 * text_width(text)));
  };
  std::vector<bool> numbers(table.header.size(), false);
  for (std::size_t i = 0; i < table.header.size(); ++i) widen(i, table.header[i]);
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widen(i, row[i].text);
      if (row[i].number && i < numbers.size()) numbers[i] = true;
    }
  }
  std::vector<double> lefts(widths.size() + 1, gap / 2);
  for (std::size_t i = 0; i < widths.size(); ++i) lefts[i + 1] = lefts[i] + widths[i] + gap;
  const double width = std::max(200.0, lefts.back() - gap / 2);
  const double height = row_height * static_cast<double>(table.rows.size() + 1) + 16;
  Drawing drawing(width, height, figure.title);
  const auto write = [&](std::size_t i, double y, const std::string& text, bool to_right,
                         const std::string& style) {
    const std::string shown = shortened(text, most);
    if (to_right) {
      drawing.text({lefts[i] + widths[i], y}, shown, at_end(style));
    } else {
      drawing.text({lefts[i], y}, shown, style);
    }
  };
  for (std::size_t i = 0; i < table.header.size(); ++i)
    write(i, 20, table.header[i], numbers[i], std::string(soft));
  drawing.line({0, 28}, {width, 28}, outline);
  double y = 28;
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const Table::Cell& cell = row[i];
      if (cell.share > 0) {
        drawing.rectangle({lefts[i] - gap / 2, y + 1}, widths[i] + gap, row_height - 2,
                          fmt::format("fill=\"#0072b2\" fill-opacity=\"{:.3f}\"",
                                      0.06 + 0.3 * std::min(1.0, cell.share)));
      }
      write(i, y + 16, cell.text, cell.number,
            std::string(ink) + (cell.best ? " font-weight=\"bold\"" : ""));
    }
    y += row_height;
  }
  drawing.line({0, y}, {width, y}, outline);
  return drawing.str();
}

std::string svg_of(const Figure& figure, const Report& report) {
  struct {
    const Figure& figure;
    const Report& report;
    std::string operator()(const Projection& projection) const {
      return draw(projection, figure, report);
    }
    std::string operator()(const Plot& plot) const { return draw(plot, figure); }
    std::string operator()(const Timeline& timeline) const { return draw(timeline, figure); }
    std::string operator()(const Intervals& intervals) const { return draw(intervals, figure); }
    std::string operator()(const Table& table) const { return draw(table, figure); }
  } const drawer{figure, report};
  return std::visit(drawer, figure.content);
}

}  // namespace cordon::report
