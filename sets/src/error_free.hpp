// SPDX-License-Identifier: GPL-3.0-or-later
// Sums and products with a bound of what their rounding lost, zero if nothing was lost [Ogita2005].
// Each operation's error is known exactly; the bound is the sum of their magnitudes, rounded up.
#pragma once

#include <cmath>

#include "cordon/core/rounding.hpp"
#include "cordon/core/types.hpp"

namespace cordon::sets {

/// a + b ≥ 0, rounded up; exact if one is zero.
inline double plus_up(double a, double b) {
  return a == 0 ? b : b == 0 ? a : (a + b) * (1 + 4 * rounding::unit);
}
/// a b ≥ 0, rounded up.
inline double times_up(double a, double b) {
  return a == 0 || b == 0 ? 0.0 : a * b * (1 + 4 * rounding::unit) + rounding::tiny;
}

/// A number with |exact - value| ≤ error. After an overflow the value is not finite.
struct Tracked {
  double value = 0, error = 0;

  void add(double x) {
    const double s = value + x, part = s - value;
    widen(std::abs((value - (s - part)) + (x - part)));
    value = s;
  }
  void subtract(double x) { add(-x); }
  void add_product(double a, double b) {
    if (a == 0 || b == 0) return;
    const double p = a * b;
    widen(std::abs(p) > directed::safe ? std::abs(std::fma(a, b, -p)) : rounding::tiny);
    add(p);
  }
  void subtract_product(double a, double b) { add_product(-a, b); }
  void add(const Tracked& x) {
    widen(x.error);
    add(x.value);
  }
  void widen(double more) { error = plus_up(error, more); }
  /// Upper bound of |exact|.
  double magnitude() const { return plus_up(std::abs(value), error); }
};

/// Row i of A times column j of B.
template <class Left, class Right>
Tracked tracked_dot(const Left& a, const Right& b) {
  Tracked sum;
  for (Index k = 0; k < a.size(); ++k) sum.add_product(a[k], b[k]);
  return sum;
}

/// A B; the errors of row i are added to radius[i].
inline Matrix tracked_product(MatrixIn A, MatrixIn B, Vector& radius) {
  Matrix C(A.rows(), B.cols());
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < B.cols(); ++j) {
      const Tracked entry = tracked_dot(A.row(i), B.col(j));
      C(i, j) = entry.value;
      radius[i] = plus_up(radius[i], entry.error);
    }
  }
  return C;
}

}  // namespace cordon::sets
