// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of a table that matter, side by side as people read them: means with deviations, the
// best ones marked.
#pragma once

#include <string>
#include <vector>

#include "cordon/study/statistics.hpp"

namespace cordon {

struct ComparisonColumn {
  std::string title;      ///< for people: "mean radius"
  std::string name;       ///< of the result, or of the axis
  bool number = false;    ///< aligned to the right
  bool relative = false;  ///< the mean as a multiple of the smallest one beside it
  friend bool operator==(const ComparisonColumn&, const ComparisonColumn&) = default;
};

struct ComparisonCell {
  std::string text;   ///< UTF-8: "1.689 ± 0.012"; "–": there is none
  bool best = false;  ///< among the pipelines under the same combination of values
};

struct ComparisonTable {
  std::vector<ComparisonColumn> columns;          ///< axes, pipeline, measures
  std::vector<std::vector<ComparisonCell>> rows;  ///< by combination, then by pipeline
  std::vector<std::size_t> groups;                ///< first row of each combination
  std::vector<std::string> notes;                 ///< what the marks in the cells mean
};

/// Of all columns those that are shown in comparisons (`Measure`) and have a number: what the
/// metrics found, then the host's own numbers, as delays and rates of diagnoses, cost, times.
ComparisonTable comparison_table(const ResultTable& table, const Summary& summary);

/// A number with so many significant digits, as short as people write it: "0.00123", "1.20",
/// "3.4e+07", "∞", "–" for NaN. Whole numbers below a million are written out.
std::string number_text(double value, int digits = 4);

}  // namespace cordon
