// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/rounding.hpp"
#include "cordon/core/types.hpp"
#include "cordon/interfaces/set.hpp"

namespace cordon::estimators {

/// The largest magnitudes of the points of X.
inline Vector magnitudes(const Enclosure& X) {
  const Box hull = X->interval_hull();
  return hull.lower.cwiseAbs().cwiseMax(hull.upper.cwiseAbs());
}

/// By how much the numbers can be off that were rounded to the entries of A. What rounded to 0 was
/// 0.
inline Matrix rounding_radius(const Matrix& A) {
  const Matrix sizes = A.cwiseAbs();
  return (sizes.array() > 0)
      .select(sizes * (rounding::unit * (1 + 4 * rounding::unit)) +
                  Matrix::Constant(A.rows(), A.cols(), rounding::tiny),
              0.0);
}

/// Is there a radius above 0? A radius of size 0×0 stands for 0.
inline bool has_spread(const Matrix& radius) { return radius.size() != 0 && radius.maxCoeff() > 0; }

/// radius · s, s ≥ 0: what an interval matrix leaves open for a vector of these magnitudes, rounded
/// upwards. A zero keeps an infinite entry of s out. 0 of the size `rows` for a radius of size 0×0.
inline Vector interval_spread(const Matrix& radius, const Vector& s, Index rows) {
  Vector sum = Vector::Zero(rows);
  for (Index j = 0; j < radius.cols(); ++j) {
    for (Index i = 0; i < rows; ++i) {
      if (radius(i, j) > 0) sum[i] += radius(i, j) * s[j];
    }
  }
  return sum * (1 + rounding::gamma(radius.cols() + 3));
}

}  // namespace cordon::estimators
