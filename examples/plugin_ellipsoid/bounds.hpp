// SPDX-License-Identifier: GPL-3.0-or-later
// Upper bounds of what doubles compute, for the rounding box of an ellipsoid.
#pragma once

#include <cordon/core/rounding.hpp>

#include "ellipsoid.hpp"

namespace ellipsoid {

namespace rounding = cordon::rounding;

constexpr double unit = rounding::unit;
/// Sums of bounds that are computed in a handful of operations are enlarged by this.
constexpr double enlarge = 1 + 64 * unit;

/// Upper bounds of the row sums of |A|.
inline Vector row_sums(const Matrix& A) {
  return A.cwiseAbs().rowwise().sum() * (1 + rounding::gamma(A.cols() + 1));
}
/// Upper bound of ‖x‖₂.
inline double norm_bound(VectorIn x) {
  return x.size() ? rounding::up(x.stableNorm() * (1 + rounding::gamma(2 * x.size() + 8))) : 0;
}
/// Upper bound of |a|ᵀ r for r ≥ 0.
inline double weighted(VectorIn a, VectorIn r) {
  return a.size() ? rounding::dot(a.cwiseAbs(), r).upper : 0;
}

}  // namespace ellipsoid
