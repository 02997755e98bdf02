// SPDX-License-Identifier: GPL-3.0-or-later
// Figures as SVG files: which drawing is of which kind, and those that are a few rows of text.
#include "experiments/report/svg.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "page/svg_parts.hpp"

namespace cordon::report {

namespace {

constexpr double line_height = 15, row_space = 9, column_gap = 22, widest = 320;
using Lines = std::vector<std::string>;

/// Broken at spaces where it is wider than a column may be.
Lines wrapped(const std::string& text) {
  Lines lines(1);
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = shortened(text.substr(begin, end - begin), widest);
    const std::string longer = lines.back().empty() ? word : lines.back() + ' ' + word;
    if (lines.back().empty() || text_width(longer) <= widest) {
      lines.back() = longer;
    } else {
      lines.push_back(word);
    }
    begin = end + 1;
  }
  return lines;
}

/// Where columns begin, how wide they are, and which hold numbers.
struct Columns {
  std::vector<double> lefts{column_gap / 2}, widths;
  std::vector<bool> numbers;

  explicit Columns(const Table& table) : numbers(table.header.size(), false) {
    for (std::size_t i = 0; i < table.header.size(); ++i) widen(i, table.header[i]);
    for (const auto& row : table.rows) {
      for (std::size_t i = 0; i < row.size(); ++i) {
        widen(i, row[i].text);
        if (row[i].number && i < numbers.size()) numbers[i] = true;
      }
    }
    for (const double width : widths) lefts.push_back(lefts.back() + width + column_gap);
  }

  void widen(std::size_t column, const std::string& text) {
    if (column >= widths.size()) widths.resize(column + 1, 0);
    for (const std::string& line : wrapped(text))
      widths[column] = std::max(widths[column], std::min(widest, 1.08 * text_width(line)));
  }
};

double height_of(std::size_t lines) { return line_height * static_cast<double>(lines) + row_space; }

double height_of(const std::vector<Table::Cell>& row) {
  std::size_t lines = 1;
  for (const Table::Cell& cell : row) lines = std::max(lines, wrapped(cell.text).size());
  return height_of(lines);
}

void write_cell(Drawing& drawing, const Columns& columns, std::size_t i, double top,
                const Table::Cell& cell, const std::string& style) {
  double y = top + 16;
  for (const std::string& line : wrapped(cell.text)) {
    cell.number ? drawing.text({columns.lefts[i] + columns.widths[i], y}, line, at_end(style))
                : drawing.text({columns.lefts[i], y}, line, style);
    y += line_height;
  }
}

}  // namespace

std::string draw(const Table& table, const Figure& figure) {
  const Columns columns(table);
  std::vector<Table::Cell> header;
  for (std::size_t i = 0; i < table.header.size(); ++i)
    header.push_back({table.header[i], false, 0, columns.numbers[i]});
  const double width = std::max(200.0, columns.lefts.back() - column_gap / 2);
  double height = height_of(header) + 20;
  for (const auto& row : table.rows) height += height_of(row);
  Drawing drawing(width, height, figure.title);
  double y = 4 + height_of(header);
  for (std::size_t i = 0; i < header.size(); ++i)
    write_cell(drawing, columns, i, 4, header[i], std::string(soft));
  drawing.line({0, y}, {width, y}, outline);
  for (const auto& row : table.rows) {
    const double row_height = height_of(row);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const Table::Cell& cell = row[i];
      if (cell.share > 0) {
        drawing.rectangle({columns.lefts[i] - column_gap / 2, y + 1},
                          columns.widths[i] + column_gap, row_height - 2,
                          fmt::format("fill=\"#0072b2\" fill-opacity=\"{:.3f}\"",
                                      0.06 + 0.3 * std::min(1.0, cell.share)));
      }
      write_cell(drawing, columns, i, y, cell,
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
