// SPDX-License-Identifier: GPL-3.0-or-later
// Scalar intervals rounded outward without changing the rounding mode: the rounding error of one
// operation is found by an error-free transformation, and a bound moves to the next double only if
// that error is not zero [Ogita2005].
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/rounding.hpp"

namespace cordon::sets::directed {

/// Below this magnitude the error of a product or quotient may underflow: bounds are then always
/// moved.
inline constexpr double safe = 1e-290;

/// The sum of two doubles rounded down and up; not finite after an overflow.
inline rounding::Range plus(double a, double b) {
  const double s = a + b, part = s - a;
  const double error = (a - (s - part)) + (b - part);
  return {error >= 0 ? s : rounding::down(s), error <= 0 ? s : rounding::up(s)};
}

inline rounding::Range times(double a, double b) {
  if (a == 0 || b == 0) return {0.0, 0.0};
  const double p = a * b;
  if (!(std::abs(p) > safe)) return {rounding::down(p), rounding::up(p)};
  const double error = std::fma(a, b, -p);
  return {error >= 0 ? p : rounding::down(p), error <= 0 ? p : rounding::up(p)};
}

inline rounding::Range over(double a, double b) {
  if (a == 0) return {0.0, 0.0};
  const double q = a / b;
  if (!(std::abs(q) > safe) || !(std::abs(a) > safe)) return {rounding::down(q), rounding::up(q)};
  const double remainder = std::fma(-q, b, a), error = b > 0 ? remainder : -remainder;
  return {error >= 0 ? q : rounding::down(q), error <= 0 ? q : rounding::up(q)};
}

/// Interval sum, scaling, quotient and product; operands are finite.
inline rounding::Range plus(rounding::Range x, rounding::Range y) {
  return {plus(x.lower, y.lower).lower, plus(x.upper, y.upper).upper};
}
inline rounding::Range minus(rounding::Range x, rounding::Range y) {
  return plus(x, {-y.upper, -y.lower});
}
inline rounding::Range times(double a, rounding::Range x) {
  return a > 0 ? rounding::Range{times(a, x.lower).lower, times(a, x.upper).upper}
               : rounding::Range{times(a, x.upper).lower, times(a, x.lower).upper};
}
inline rounding::Range over(rounding::Range x, double a) {
  return a > 0 ? rounding::Range{over(x.lower, a).lower, over(x.upper, a).upper}
               : rounding::Range{over(x.upper, a).lower, over(x.lower, a).upper};
}
inline rounding::Range times(rounding::Range a, rounding::Range x) {
  const rounding::Range p = times(a.lower, x), q = times(a.upper, x);
  return {std::min(p.lower, q.lower), std::max(p.upper, q.upper)};
}

inline bool is_finite(rounding::Range x) {
  return std::isfinite(x.lower) && std::isfinite(x.upper);
}
inline rounding::Range line() { return {-infinity, infinity}; }

}  // namespace cordon::sets::directed
