// SPDX-License-Identifier: GPL-3.0-or-later
// Upper bounds of what doubles compute, for the rounding box of an ellipsoid.
#pragma once

#include <cmath>

#include "cordon/core/rounding.hpp"
#include "cordon/core/types.hpp"

namespace cordon::sets::ellipsoids {

using rounding::unit;

/// Sums of bounds that are computed in a handful of operations are enlarged by this.
inline constexpr double enlarge = 1 + 64 * unit;

/// ‖x‖₂ as computed: within (k/2 + 2) units of its last place of the exact one.
template <class Entries>
double length(const Entries& x) {
  const double square = x.squaredNorm();
  return square > 1e-270 && square < 1e270 ? std::sqrt(square) : x.stableNorm();
}
/// Upper bound of it. Squares that underflow are covered.
template <class Entries>
double length_up(const Entries& x) {
  const double computed = x.size() ? length(x) : 0;
  return computed == 0 ? 0 : computed * (1 + rounding::gamma(2 * x.size() + 16)) + rounding::tiny;
}
/// Upper bounds of the row sums of |A|.
inline Vector row_sums(MatrixIn A) {
  return A.cwiseAbs().rowwise().sum() * (1 + rounding::gamma(A.cols() + 1));
}
/// Upper bound of |a|ᵀ r for r ≥ 0.
inline double weighted(VectorIn a, VectorIn r) {
  return a.size() ? a.cwiseAbs().dot(r) * (1 + rounding::gamma(2 * a.size() + 4)) +
                        static_cast<double>(a.size()) * rounding::tiny
                  : 0;
}
/// Upper bound of what L u is off by, in 2-norm of each row, after Lᵀd was computed: |d|ᵀ(|L| 1) of
/// a product of n terms each.
inline double product_slack(MatrixIn L, VectorIn d) {
  return rounding::gamma(2 * L.rows() + 4) * weighted(d, row_sums(L)) +
         static_cast<double>((L.rows() + 1) * L.cols()) * rounding::tiny;
}

}  // namespace cordon::sets::ellipsoids
