// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/formulas/elementary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mpfr.h>

namespace cordon::elementary {

namespace {

constexpr double largest_angle = 0x1p20;  // beyond it periods are not told apart
constexpr int double_bits = 53;

/// A number of MPFR's with the digits of a double, one per thread.
class MpfrNumber {
 public:
  MpfrNumber() { mpfr_init2(number_, double_bits); }
  ~MpfrNumber() {
    mpfr_clear(number_);
    mpfr_free_cache();
  }
  MpfrNumber(const MpfrNumber&) = delete;
  MpfrNumber& operator=(const MpfrNumber&) = delete;
  mpfr_ptr get() { return number_; }

 private:
  mpfr_t number_;
};

mpfr_ptr first_number() {
  thread_local MpfrNumber number;
  return number.get();
}
mpfr_ptr second_number() {
  thread_local MpfrNumber number;
  return number.get();
}

/// y as the C library computes it, with what it may be off by.
Interval widened(double y) {
  Interval range{y, y};
  for (int i = 0; i < library_error; ++i)
    range = {rounding::down(range.lower), rounding::up(range.upper)};
  return range;
}

/// Bounds of MPFR's, where a value that is not bounded at a pole lies beyond all doubles.
Interval proper(double lower, double upper) {
  constexpr double largest = std::numeric_limits<double>::max();
  return {std::min(lower, largest), std::max(upper, -largest)};
}

struct UnaryFunction {
  double (*nominal)(double);
  int (*correct)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);

  /// Bounds of the value at one point.
  Interval at(double x, Rounding rounding) const {
    if (rounding == Rounding::nominal) return widened(nominal(x));
    const auto rounded = [&](mpfr_rnd_t direction) {
      const mpfr_ptr number = first_number();
      mpfr_set_d(number, x, direction);
      correct(number, number, direction);
      return mpfr_get_d(number, direction);
    };
    return proper(rounded(MPFR_RNDD), rounded(MPFR_RNDU));
  }
  /// The range of a function that increases.
  Interval increasing(Interval x, Rounding rounding) const {
    if (x.is_point()) return at(x.lower, rounding);
    return {at(x.lower, rounding).lower, at(x.upper, rounding).upper};
  }
};

constexpr UnaryFunction exponential{std::exp, mpfr_exp}, logarithm{std::log, mpfr_log},
    sine{std::sin, mpfr_sin}, cosine{std::cos, mpfr_cos}, tangent{std::tan, mpfr_tan},
    arcsine{std::asin, mpfr_asin}, arccosine{std::acos, mpfr_acos},
    arctangent{std::atan, mpfr_atan};

Interval power_at(double x, double p, Rounding rounding) {
  if (x == 0 && p > 0) return {0, 0};
  if (rounding == Rounding::nominal) return intersection(widened(std::pow(x, p)), {0, infinity});
  const auto rounded = [&](mpfr_rnd_t direction) {
    const mpfr_ptr base = first_number(), exponent = second_number();
    mpfr_set_d(base, x, direction);
    mpfr_set_d(exponent, p, direction);
    mpfr_pow(base, base, exponent, direction);
    return mpfr_get_d(base, direction);
  };
  return proper(rounded(MPFR_RNDD), rounded(MPFR_RNDU));
}

/// xⁿ for x ≥ 0 and n ≥ 1.
Interval power_of_positive(Interval x, int n) {
  Interval result{1, 1};
  for (Interval square = x;; square = square * square) {
    if (n % 2 == 1) result = result * square;
    n /= 2;
    if (n == 0) return intersection(result, {0, infinity});
  }
}

/// Does x contain one of the points phase + 2πm, as far as can be told?
bool may_contain(Interval x, Interval phase) {
  const Interval turns = (x - phase) / (2 * pi);
  return std::floor(turns.upper) >= std::ceil(turns.lower);
}

/// Range of a function with values in [-1,1] that has its maxima and minima once in every period.
Interval periodic(const UnaryFunction& function, Interval x, Rounding rounding, Interval maximum,
                  Interval minimum) {
  if (!(x.magnitude() <= largest_angle) || x.upper - x.lower >= 2 * pi.lower) return {-1, 1};
  const Interval first = function.at(x.lower, rounding), last = function.at(x.upper, rounding);
  const Interval ends = intersection(hull(first, last), {-1, 1});
  return {may_contain(x, minimum) ? -1 : ends.lower, may_contain(x, maximum) ? 1 : ends.upper};
}

/// √x rounded down and up, by the remainder x - r².
Interval root_at(double x) {
  if (x == 0 || std::isinf(x)) return {x, x};
  if (x < directed::safe) {  // the remainder could underflow
    const Interval scaled = root_at(x * 0x1p200);
    return {scaled.lower * 0x1p-100, scaled.upper * 0x1p-100};
  }
  const double r = std::sqrt(x);
  const double remainder = std::fma(-r, r, x);
  return {remainder >= 0 ? r : rounding::down(r), remainder <= 0 ? r : rounding::up(r)};
}

}  // namespace

Interval sqrt(Interval x) { return {root_at(x.lower).lower, root_at(x.upper).upper}; }

Interval reciprocal_of_positive(Interval x) {
  return {std::isinf(x.upper) ? 0 : directed::over(1, x.upper).lower,
          x.lower > 0 ? directed::over(1, x.lower).upper : infinity};
}

Interval abs(Interval x) {
  if (x.lower >= 0) return x;
  if (x.upper <= 0) return -x;
  return {0, x.magnitude()};
}

Interval min(Interval x, Interval y) {
  return {std::min(x.lower, y.lower), std::min(x.upper, y.upper)};
}
Interval max(Interval x, Interval y) {
  return {std::max(x.lower, y.lower), std::max(x.upper, y.upper)};
}

Interval power(Interval x, int n) {
  if (n == 0) return {1, 1};
  if (n == 1) return x;
  if (n < 0) {
    const Interval size = reciprocal_of_positive(power_of_positive(abs(x), -n));
    return n % 2 == 0 || x.lower > 0 ? size : -size;
  }
  if (n % 2 == 0) return power_of_positive(abs(x), n);
  if (x.lower >= 0) return power_of_positive(x, n);
  if (x.upper <= 0) return -power_of_positive(-x, n);
  return {-power_of_positive({0, -x.lower}, n).upper, power_of_positive({0, x.upper}, n).upper};
}

Interval exp(Interval x, Rounding rounding) {
  return intersection(exponential.increasing(x, rounding), {0, infinity});
}
Interval log(Interval x, Rounding rounding) { return logarithm.increasing(x, rounding); }

Interval sin(Interval x, Rounding rounding) {
  return periodic(sine, x, rounding, 0.5 * pi, -0.5 * pi);
}
Interval cos(Interval x, Rounding rounding) { return periodic(cosine, x, rounding, {0, 0}, pi); }

Domain tan_domain(Interval x) {
  if (!(x.magnitude() <= largest_angle)) return Domain::part;
  const Interval half_turns = (x + 0.5 * pi) / pi;
  return std::floor(half_turns.lower) == std::floor(half_turns.upper) ? Domain::all : Domain::part;
}
Interval tan(Interval x, Rounding rounding) { return tangent.increasing(x, rounding); }

Interval asin(Interval x, Rounding rounding) {
  return intersection(arcsine.increasing(x, rounding), {-(0.5 * pi).upper, (0.5 * pi).upper});
}
Interval acos(Interval x, Rounding rounding) {
  return intersection(
      {arccosine.at(x.upper, rounding).lower, arccosine.at(x.lower, rounding).upper},
      {0, pi.upper});
}
Interval atan(Interval x, Rounding rounding) {
  return intersection(arctangent.increasing(x, rounding), {-(0.5 * pi).upper, (0.5 * pi).upper});
}

Interval power(Interval x, Interval p, Rounding rounding) {
  // Monotone in each of the two, so that the extremes are at corners.
  const Interval left =
      hull(power_at(x.lower, p.lower, rounding), power_at(x.lower, p.upper, rounding));
  const Interval right =
      hull(power_at(x.upper, p.lower, rounding), power_at(x.upper, p.upper, rounding));
  return hull(left, right);
}

Interval atan_second_derivative(Interval x) {
  const auto at = [](double t) {
    if (std::isinf(t)) return Interval{0, 0};
    return (-2.0 * Interval{t, t}) * power(Interval{1, 1} + power({t, t}, 2), -2);
  };
  // Its extremes are at ± 1/√3, of magnitude 9 / (8 √3).
  const Interval root = sqrt({3, 3}), place = Interval{1, 1} / root,
                 extreme = Interval{9, 9} / (8.0 * root);
  Interval range = hull(at(x.lower), at(x.upper));
  if (x.lower <= place.upper && x.upper >= place.lower) range.lower = -extreme.upper;
  if (x.lower <= -place.lower && x.upper >= -place.upper) range.upper = extreme.upper;
  return range;
}

}  // namespace cordon::elementary
