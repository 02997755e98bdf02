// SPDX-License-Identifier: GPL-3.0-or-later
// Estimates that become wider and wider.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cordon/core/box.hpp"
#include "cordon/study/run.hpp"

namespace cordon::detail {

/// Watches the widths of the hulls of one pipeline. A state's bounds grow if the last width is at
/// least ten times the smallest one that lasted ten samples after the start (of the first ten
/// nothing is said; a single lucky measurement is no width to compare with), and no less than half
/// of the largest one, so that it is wide at the end. Empty, unbounded and flat hulls count for
/// nothing.
class GrowthWatch {
 public:
  void step(Index k, const Box& hull);

  /// The state whose width has grown most, if one has grown.
  std::optional<WidthGrowth> growth() const;

 private:
  struct Sample {
    Index k = 0;
    double width = 0;
  };
  struct Width {
    double smallest = 0, largest = 0, last = 0;
    Index smallest_at = -1, samples = 0;
    std::array<Sample, 10> recent = {};
  };
  std::vector<Width> widths_;
};

}  // namespace cordon::detail
