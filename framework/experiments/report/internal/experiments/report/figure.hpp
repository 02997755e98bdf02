// SPDX-License-Identifier: GPL-3.0-or-later
// What a report shows, apart from how: made from the files of a run, drawn as a page, as SVG, or
// written as CSV.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cordon/core/types.hpp"

namespace cordon::report {

/// Whose a series is: of one of the report's pipelines (its colour and its switch), or of the data.
inline constexpr int of_data = -1;

/// Numbers over a common axis. NaN is a gap; ±∞ is drawn to the edge of the figure.
struct Series {
  enum class Kind {
    line,    ///< y over x
    band,    ///< between y and `upper`
    points,  ///< single values
    steps    ///< y holds until the next x
  };
  Kind kind = Kind::line;
  std::string name;  ///< for the legend; empty: it has no entry there
  int pipeline = of_data;
  std::vector<double> x, y;
  std::vector<double> upper = {};  ///< of bands
  int shade = 0;                   ///< several series of one pipeline: modes for example
};

/// Something happens at x: a vertical line with its text above, or a small triangle at the lower
/// axis, whose text is an entry of the legend, one for all with this text.
struct Mark {
  double x = 0;
  std::string text;
  int pipeline = of_data;
  bool small = false;
};

struct Plot {
  std::string x_label, y_label;
  bool log_y = false;
  std::vector<Series> series;
  std::vector<std::pair<std::string, double>> thresholds = {};  ///< horizontal lines with a name
  std::vector<Mark> marks = {};
  std::vector<std::string> x_names = {};  ///< not empty: x = 0, 1, … are these words
  /// What the vertical axis has to show; more is cut off. Empty: everything.
  std::optional<std::pair<double, double>> range = {};
  std::string note = {};  ///< below the legend of a drawing, which has no caption; may be empty
};

/// A convex polygon, counter-clockwise. No vertices: the set is proven empty.
struct Polygon {
  int pipeline = 0;
  std::vector<double> x, y;
  std::vector<bool> open =
      {};  ///< per edge i → i+1: it lies on the frame, the set goes on beyond it; empty: none does
};

/// The sets of all pipelines at one time.
struct SetFrame {
  std::int64_t k = 0;
  double left = 0, right = 1, bottom = 0, top = 1;  ///< of what is drawn
  std::vector<Polygon> sets;
  std::optional<std::pair<double, double>> truth = {};
  std::string time = {};  ///< for people, "k = 12 (6 s)"; empty: k is enough
};

/// Projections to two coordinates, one time after another (a slider).
struct Projection {
  std::string x_label, y_label;
  std::vector<SetFrame> frames;
};

/// Which mode is in which state when.
struct Timeline {
  /// `unconsidered`: the study begins in another mode, and nothing was proven of this one.
  enum class State { candidate, monitored, excluded, unconsidered, truth, outside };
  struct Span {
    std::size_t row = 0;
    double from = 0, to = 0;  ///< both included
    State state = State::candidate;
  };
  std::vector<std::string> rows;
  std::vector<Span> spans;
  std::vector<Mark> marks;
  std::string x_label = "k";
  double step = 1;  ///< from one sample to the next
};

/// Intervals that must not overlap, in rows: two tubes seen along the direction that separates
/// them.
struct Intervals {
  struct Row {
    std::string name;
    std::string first, second;  ///< whose intervals
    double first_lower = 0, first_upper = 0, second_lower = 0, second_upper = 0;
    std::string verdict;  ///< proven disjoint, …
  };
  std::vector<Row> rows;
};

/// Cells as text; the best of a column, or of a group of rows, is marked.
struct Table {
  struct Cell {
    std::string text;
    bool best = false;
    double share = 0;     ///< 0 … 1, how dark the cell is; 0: not at all
    bool number = false;  ///< aligned to the right
  };
  std::vector<std::string> header;
  std::vector<std::vector<Cell>> rows;
};

struct Figure {
  std::string id;       ///< [a-z0-9_]+, unique: the name of its files
  std::string section;  ///< heading that it stands under
  std::string title, caption;
  std::variant<Plot, Projection, Timeline, Intervals, Table> content;
  int pipeline = of_data;  ///< not `of_data`: the whole figure is of this pipeline
};

struct Report {
  std::string title;
  std::vector<std::string> pipelines;  ///< names, in the order of the colours
  std::vector<std::string>
      notes;                    ///< what a reader must know first: violations, errors, decimation
  std::vector<Figure> figures;  ///< in the order of the page
  std::vector<std::pair<std::string, std::string>>
      versions;       ///< program, tools, plugins, hash of the study, host
  std::string study;  ///< the resolved study, JSON text
};

}  // namespace cordon::report
