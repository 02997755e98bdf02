// SPDX-License-Identifier: GPL-3.0-or-later
// Scalar intervals rounded outward without changing the rounding mode: the rounding error of one
// operation is found by an error-free transformation, and a bound moves to the next double only if
// that error is not zero [Ogita2005]. An operation whose result is representable is exact.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "cordon/core/types.hpp"

namespace cordon {

/// {x ∈ R : lower ≤ x ≤ upper}; bounds may be infinite, never NaN. Empty if lower > upper. The
/// operations below take intervals that are not empty, and enclose the results of all real
/// operands; 0·∞ = 0.
struct Interval {
  double lower, upper;

  bool is_finite() const { return std::isfinite(lower) && std::isfinite(upper); }
  bool is_empty() const { return lower > upper; }
  bool is_point() const { return lower == upper; }
  bool contains(double x) const { return lower <= x && x <= upper; }
  double magnitude() const { return std::max(std::abs(lower), std::abs(upper)); }
  bool operator==(const Interval&) const = default;
};

inline constexpr Interval real_line{-infinity, infinity};

namespace rounding {

/// The next double above or below; infinities and NaN stay. Doubles of one sign are ordered like
/// their bits.
inline double up(double x) {
  if (!(x < infinity)) return x;
  if (x == 0) return std::numeric_limits<double>::denorm_min();
  const auto bits = std::bit_cast<std::uint64_t>(x);
  return std::bit_cast<double>(x > 0 ? bits + 1 : bits - 1);
}
inline double down(double x) { return -up(-x); }

}  // namespace rounding

namespace directed {

/// Below this magnitude the error of a product or quotient may underflow: bounds are then always
/// moved.
inline constexpr double safe = 1e-290;

/// Sum, product and quotient of two doubles rounded down and up.
inline Interval plus(double a, double b) {
  const double s = a + b, part = s - a;
  const double error = (a - (s - part)) + (b - part);
  return {error >= 0 ? s : rounding::down(s), error <= 0 ? s : rounding::up(s)};
}
inline Interval times(double a, double b) {
  if (a == 0 || b == 0) return {0.0, 0.0};
  const double p = a * b;
  if (!(std::abs(p) > safe)) return {rounding::down(p), rounding::up(p)};
  const double error = std::fma(a, b, -p);
  return {error >= 0 ? p : rounding::down(p), error <= 0 ? p : rounding::up(p)};
}
inline Interval over(double a, double b) {
  if (a == 0) return {0.0, 0.0};
  const double q = a / b;
  if (!(std::abs(q) > safe) || !(std::abs(a) > safe)) return {rounding::down(q), rounding::up(q)};
  const double remainder = std::fma(-q, b, a), error = b > 0 ? remainder : -remainder;
  return {error >= 0 ? q : rounding::down(q), error <= 0 ? q : rounding::up(q)};
}

}  // namespace directed

inline Interval operator-(Interval x) { return {-x.upper, -x.lower}; }
inline Interval operator+(Interval x, Interval y) {
  return {directed::plus(x.lower, y.lower).lower, directed::plus(x.upper, y.upper).upper};
}
inline Interval operator-(Interval x, Interval y) { return x + -y; }
inline Interval operator*(double a, Interval x) {
  return a > 0 ? Interval{directed::times(a, x.lower).lower, directed::times(a, x.upper).upper}
               : Interval{directed::times(a, x.upper).lower, directed::times(a, x.lower).upper};
}
inline Interval operator*(Interval x, Interval y) {
  const auto corners = [](double a, double b, double c, double d) {
    return Interval{directed::times(a, b).lower, directed::times(c, d).upper};
  };
  if (x.lower >= 0) {
    if (y.lower >= 0) return corners(x.lower, y.lower, x.upper, y.upper);
    if (y.upper <= 0) return corners(x.upper, y.lower, x.lower, y.upper);
    return corners(x.upper, y.lower, x.upper, y.upper);
  }
  if (x.upper <= 0) {
    if (y.lower >= 0) return corners(x.lower, y.upper, x.upper, y.lower);
    if (y.upper <= 0) return corners(x.upper, y.upper, x.lower, y.lower);
    return corners(x.lower, y.upper, x.lower, y.lower);
  }
  if (y.lower >= 0) return corners(x.lower, y.upper, x.upper, y.upper);
  if (y.upper <= 0) return corners(x.upper, y.lower, x.lower, y.lower);
  return {
      std::min(directed::times(x.lower, y.upper).lower, directed::times(x.upper, y.lower).lower),
      std::max(directed::times(x.lower, y.lower).upper, directed::times(x.upper, y.upper).upper)};
}
/// x / a, a ≠ 0.
inline Interval operator/(Interval x, double a) {
  return a > 0 ? Interval{directed::over(x.lower, a).lower, directed::over(x.upper, a).upper}
               : Interval{directed::over(x.upper, a).lower, directed::over(x.lower, a).upper};
}
/// x / y, 0 ∉ y.
inline Interval operator/(Interval x, Interval y) {
  if (y.upper < 0) {
    x = -x;
    y = -y;
  }
  const double low = x.lower >= 0 ? y.upper : y.lower, high = x.upper >= 0 ? y.lower : y.upper;
  // A finite number over infinity is between 0 and itself; nothing smaller than 0 is needed.
  return {std::isinf(low) ? 0.0 : directed::over(x.lower, low).lower,
          std::isinf(high) ? 0.0 : directed::over(x.upper, high).upper};
}

inline Interval intersection(Interval x, Interval y) {
  return {std::max(x.lower, y.lower), std::min(x.upper, y.upper)};
}
inline Interval hull(Interval x, Interval y) {
  return {std::min(x.lower, y.lower), std::max(x.upper, y.upper)};
}

}  // namespace cordon
