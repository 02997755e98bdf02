// SPDX-License-Identifier: GPL-3.0-or-later
// Tables: rows of text.
#include <algorithm>

#include <fmt/format.h>

#include "page/svg_parts.hpp"

namespace cordon::report {

namespace {

constexpr double line_height = 15, row_space = 9;
constexpr double widest_cell = 320, least_sentence = 160;  ///< of texts that fill several lines
/// Of the whole: that of the widest other figures, so that texts are as large where both are
/// printed at one width.
constexpr double widest_table = 960;
using Lines = std::vector<std::string>;

/// With room for bold letters.
double room_of(std::string_view text) { return 1.08 * text_width(text); }

/// What a line may be broken between: words, with the space before them, and what ends with "_".
Lines pieces_of(const std::string& text) {
  Lines pieces(1);
  for (const char c : text) {
    if (c == ' ') pieces.emplace_back();
    pieces.back() += c;
    if (c == '_') pieces.emplace_back();
  }
  return pieces;
}

/// Broken where it is wider than `width`.
Lines wrapped(const std::string& text, double width) {
  Lines lines(1);
  for (const std::string& piece : pieces_of(text)) {
    const std::string longer = lines.back() + piece;
    if (lines.back().empty() || room_of(longer) <= width + 1e-9) {
      lines.back() = longer;
    } else {
      lines.push_back(piece[0] == ' ' ? piece.substr(1) : piece);
    }
  }
  for (std::string& line : lines) line = shortened(line, width);
  return lines;
}

/// How wide columns are and where they begin. Long texts and headings are broken as far as the
/// table would be too wide otherwise, numbers never.
class TableLayout {
 public:
  struct Column {
    double left = 0, width = 0;
    double natural = 0, least = 0;  ///< widths without any break, and with all that may be
    bool number = false;
  };

  explicit TableLayout(const Table& table) {
    columns_.resize(table.header.size());
    for (const auto& row : table.rows) columns_.resize(std::max(columns_.size(), row.size()));
    for (std::size_t i = 0; i < table.header.size(); ++i) widen(columns_[i], table.header[i], true);
    for (const auto& row : table.rows) {
      for (std::size_t i = 0; i < row.size(); ++i) {
        columns_[i].number = columns_[i].number || row[i].number;
        widen(columns_[i], row[i].text, !row[i].number);
      }
    }
    for (Column& column : columns_) {
      if (column.natural == widest_cell) column.least = std::max(column.least, least_sentence);
    }
    for (double limit = widest_cell; limit >= 40; limit -= 10) {
      arrange(limit);
      if (width() <= widest_table) return;
    }
    gap_ = 12;
    arrange(40);
  }

  const Column& column(std::size_t i) const { return columns_[i]; }
  double gap() const { return gap_; }
  double width() const {
    return columns_.empty() ? 0 : columns_.back().left + columns_.back().width + gap_ / 2;
  }
  double height_of(const std::vector<Table::Cell>& row) const {
    std::size_t lines = 1;
    for (std::size_t i = 0; i < row.size(); ++i)
      lines = std::max(lines, wrapped(row[i].text, columns_[i].width).size());
    return line_height * static_cast<double>(lines) + row_space;
  }

 private:
  static void widen(Column& column, const std::string& text, bool breaks) {
    const double whole = std::min(widest_cell, room_of(text));
    column.natural = std::max(column.natural, whole);
    if (!breaks) column.least = std::max(column.least, whole);
    for (const std::string& piece : pieces_of(text))
      column.least = std::max(column.least, std::min(widest_cell, room_of(piece)));
  }

  void arrange(double limit) {
    double left = gap_ / 2;
    for (Column& column : columns_) {
      column.left = left;
      column.width = std::clamp(limit, column.least, column.natural);
      left += column.width + gap_;
    }
  }

  std::vector<Column> columns_;
  double gap_ = 22;
};

void write_cell(Drawing& drawing, const TableLayout& layout, std::size_t i, double top,
                const Table::Cell& cell, const std::string& style) {
  const TableLayout::Column& column = layout.column(i);
  double y = top + 16;
  for (const std::string& line : wrapped(cell.text, column.width)) {
    cell.number ? drawing.text({column.left + column.width, y}, line, at_end(style))
                : drawing.text({column.left, y}, line, style);
    y += line_height;
  }
}

}  // namespace

std::string draw(const Table& table, const Figure& figure) {
  const TableLayout layout(table);
  std::vector<Table::Cell> header;
  for (std::size_t i = 0; i < table.header.size(); ++i)
    header.push_back({table.header[i], false, 0, layout.column(i).number});
  const double width = std::max(200.0, layout.width());
  double height = layout.height_of(header) + 20;
  for (const auto& row : table.rows) height += layout.height_of(row);
  Drawing drawing(width, height, figure.title);
  double y = 4 + layout.height_of(header);
  for (std::size_t i = 0; i < header.size(); ++i)
    write_cell(drawing, layout, i, 4, header[i], std::string(soft));
  drawing.line({0, y}, {width, y}, outline);
  for (const auto& row : table.rows) {
    const double row_height = layout.height_of(row);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const Table::Cell& cell = row[i];
      if (cell.share > 0) {
        drawing.rectangle({layout.column(i).left - layout.gap() / 2, y + 1},
                          layout.column(i).width + layout.gap(), row_height - 2,
                          fmt::format("fill=\"#0072b2\" fill-opacity=\"{:.3f}\"",
                                      0.06 + 0.3 * std::min(1.0, cell.share)));
      }
      write_cell(drawing, layout, i, y, cell,
                 std::string(ink) + (cell.best ? " font-weight=\"bold\"" : ""));
    }
    y += row_height;
  }
  drawing.line({0, y}, {width, y}, outline);
  return drawing.str();
}

}  // namespace cordon::report
