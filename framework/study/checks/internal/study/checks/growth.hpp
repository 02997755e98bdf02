// SPDX-License-Identifier: GPL-3.0-or-later
// Estimates that become wider and wider.
#pragma once

#include <optional>
#include <vector>

#include "cordon/core/box.hpp"
#include "cordon/study/run.hpp"

namespace cordon::detail {

/// Watches the widths of the hulls of one pipeline. A state's bounds grow if the last width is at
/// least ten times the smallest one after the start (of the first ten samples nothing is said), and
/// no less than half of the largest one, so that it is wide at the end. Empty, unbounded and flat
/// hulls count for nothing.
class GrowthWatch {
 public:
  void step(Index k, const Box& hull);

  /// The state whose width has grown most, if one has grown.
  std::optional<WidthGrowth> growth() const;

 private:
  struct Width {
    double smallest = 0, largest = 0, last = 0;
    Index smallest_at = -1;
  };
  std::vector<Width> widths_;
};

}  // namespace cordon::detail
