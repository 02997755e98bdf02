// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "cordon/core/interval.hpp"

namespace cordon::formulas {

/// A symmetric interval matrix of few rows; both triangles are stored.
struct SmallSymmetric {
  static constexpr int most = 4;
  int size = 0;
  std::array<std::array<Interval, most>, most> entries{};
};

/// A lower bound of the eigenvalues of all its symmetric matrices: the least one is that of one of
/// 2^(n-1) vertex matrices [Hertz1992], of each of which it is proven by the pivots of an interval
/// elimination. -∞ where that fails. O(2ⁿ n³).
double least_eigenvalue(const SmallSymmetric& matrix);

}  // namespace cordon::formulas
