// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of which everything is known.
#pragma once

#include <cmath>

#include "cordon/cordon.hpp"

namespace values_test {

using namespace cordon;

/// [-1, 1]ⁿ.
inline ConvexSet unit_box(Index n) {
  return ConvexSet::box(Vector::Constant(n, -1), Vector::Constant(n, 1));
}
/// Vertices (1,2) ± {(2,2), (2,0), (0,2)}, of area 12.
inline ConvexSet hexagon() {
  return ConvexSet::zonotope(Vector{{1, 2}}, Matrix{{1, 0, 1}, {0, 1, 1}});
}
/// Corners (-1,-1), (1,-1), (-1,1): the part of the unit box where x + y ≤ 0, of area 2.
inline ConvexSet triangle() {
  return ConvexSet::constrained_zonotope(Vector::Zero(2), Matrix{{1, 0, 0}, {0, 1, 0}},
                                         Matrix{{1, 1, 1}}, Vector{{-1}});
}
/// The segment from (1,0) to (0,1).
inline ConvexSet segment() {
  return ConvexSet::constrained_zonotope(Vector::Zero(2), Matrix::Identity(2, 2), Matrix{{1, 1}},
                                         Vector{{1}});
}
/// {x : |x₁ + x₂ - 1| ≤ 0.5}.
inline ConvexSet strip() { return ConvexSet::strip(Vector{{1, 1}}, 1, 0.5); }

inline const char* const representations[] = {"interval", "zonotope", "constrained_zonotope",
                                              "line_zonotope", "ellipsoid"};

/// Does the box enclose these bounds, and by no more than rounding?
inline bool is(const Box& box, const Vector& lower, const Vector& upper) {
  const auto tight = [](double bound, double known) {
    return bound >= known && (bound == known || bound - known <= 1e-12 * (1 + std::abs(known)));
  };
  if (box.dim() != lower.size()) return false;
  for (Index i = 0; i < box.dim(); ++i) {
    if (!tight(-box.lower[i], -lower[i]) || !tight(box.upper[i], upper[i])) return false;
  }
  return true;
}

/// The same of an upper bound.
inline bool is_above(double bound, double known) {
  return is({Vector{{known}}, Vector{{bound}}}, Vector{{known}}, Vector{{known}});
}

/// One of the columns, up to rounding?
inline bool has_column(const Matrix& columns, const Vector& x) {
  for (Index j = 0; j < columns.cols(); ++j) {
    if ((columns.col(j) - x).cwiseAbs().maxCoeff() < 1e-12) return true;
  }
  return false;
}

}  // namespace values_test
