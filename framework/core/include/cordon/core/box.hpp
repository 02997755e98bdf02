// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/types.hpp"

namespace cordon {

/// Interval vector {x : lower ≤ x ≤ upper}, coordinatewise; bounds may be infinite.
/// Empty if one upper bound lies below its lower bound (the canonical empty box is [1,-1]ⁿ, or for
/// n = 0 none: R⁰ is a point).
struct Box {
  Vector lower, upper;

  Index dim() const { return lower.size(); }
  bool is_empty() const { return (lower.array() > upper.array()).any(); }
  bool is_bounded() const {
    return lower.array().isFinite().all() && upper.array().isFinite().all();
  }
  bool contains(VectorIn x) const {
    return (lower.array() <= x.array()).all() && (x.array() <= upper.array()).all();
  }
  Vector center() const;  ///< midpoint; 0 in a free coordinate
  Vector radius() const;  ///< half widths; +inf in a free coordinate
  double longest_half_edge()
      const;  ///< half the longest edge; +inf if unbounded, 0 if empty or n = 0

  static Box space(Index n);  ///< Rⁿ
  static Box empty(Index n);  ///< [1,-1]ⁿ, n ≥ 1
};

}  // namespace cordon
