// SPDX-License-Identifier: GPL-3.0-or-later
#include "inverse.hpp"

#include <cmath>
#include <span>

#include "cordon/formulas/elementary.hpp"
#include "operations.hpp"

namespace cordon::formulas {

namespace {

namespace el = elementary;

constexpr Interval positive{0, infinity};
constexpr double most_branches = 1000;    // of a periodic function
constexpr double largest_angle = 0x1p20;  // as of its range

/// The hull of the parts of `a` that lie in `one` and in `other`.
Interval hull_of_parts(Interval a, Interval part, Interval other) {
  const Interval left = part.is_empty() ? no_number : intersection(a, part),
                 right = other.is_empty() ? no_number : intersection(a, other);
  if (left.is_empty()) return right.is_empty() ? no_number : right;
  return right.is_empty() ? left : hull(left, right);
}

/// {1/z : z ≠ 0} of numbers that are not negative; empty for {0}.
Interval reciprocal(Interval z) { return z.upper > 0 ? el::reciprocal_of_positive(z) : no_number; }

/// {a ∈ [a] : |a| ∈ [size]}
Interval of_magnitude(Interval size, Interval a) {
  size = intersection(size, positive);
  if (size.is_empty()) return no_number;
  return hull_of_parts(a, -size, size);
}

/// The n-th root of numbers that are not negative, n ≥ 1.
Interval root(Interval z, int n, Rounding rounding) {
  if (n == 1) return z;
  return n == 2 ? el::sqrt(z) : el::power(z, one / static_cast<double>(n), rounding);
}

/// {a ∈ [a] : aⁿ ∈ [z]}
Interval operand_of_power(Interval z, int n, Interval a, Rounding rounding) {
  if (n == 0) return a;
  const auto size_of = [&](Interval values) {
    values = intersection(values, positive);
    if (values.is_empty()) return no_number;
    if (n < 0) values = reciprocal(values);
    return values.is_empty() ? no_number : root(values, std::abs(n), rounding);
  };
  if (n % 2 == 0) return of_magnitude(size_of(z), a);
  const Interval minus = size_of(-z);
  return hull_of_parts(a, minus.is_empty() ? no_number : -minus, size_of(z));
}

/// {a ∈ [a] : a lies in one of the intervals but for a multiple of the period}
Interval of_branches(std::span<const Interval> branches, Interval period, Interval a) {
  if (!(a.magnitude() <= largest_angle) || (a.upper - a.lower) / period.lower > most_branches)
    return a;
  const auto part = [&](double turns) {
    Interval found = no_number;
    for (const Interval branch : branches) {
      const Interval inside = intersection(a, branch + turns * period);
      if (!inside.is_empty()) found = found.is_empty() ? inside : hull(found, inside);
    }
    return found;
  };
  const double first = std::floor(a.lower / period.lower) - 2,
               last = std::ceil(a.upper / period.lower) + 2;
  Interval lowest = no_number, highest = no_number;
  for (double turns = first; turns <= last && lowest.is_empty(); ++turns) lowest = part(turns);
  if (lowest.is_empty()) return no_number;
  for (double turns = last; highest.is_empty(); --turns) highest = part(turns);
  return hull(lowest, highest);
}

Interval operand_of_sine(Interval z, Interval a, Rounding rounding) {
  z = intersection(z, {-1, 1});
  if (z.is_empty()) return no_number;
  const Interval angle = el::asin(z, rounding), branches[] = {angle, el::pi - angle};
  return of_branches(branches, 2.0 * el::pi, a);
}

Interval operand_of_cosine(Interval z, Interval a, Rounding rounding) {
  z = intersection(z, {-1, 1});
  if (z.is_empty()) return no_number;
  const Interval angle = el::acos(z, rounding), branches[] = {angle, -angle};
  return of_branches(branches, 2.0 * el::pi, a);
}

Interval operand_of_tangent(Interval z, Interval a, Rounding rounding) {
  const Interval branches[] = {el::atan(z, rounding)};
  return of_branches(branches, el::pi, a);
}

/// tan z for z within (-π/2, π/2), unbounded where z reaches its ends.
Interval operand_of_arctangent(Interval z, Interval a, Rounding rounding) {
  const Interval quarter = 0.5 * el::pi;
  z = intersection(z, {-quarter.upper, quarter.upper});
  if (z.is_empty()) return no_number;
  const auto tangent = [&](double at) { return el::tan({at, at}, rounding); };
  const Interval inside{z.lower > -quarter.lower ? tangent(z.lower).lower : -infinity,
                        z.upper < quarter.lower ? tangent(z.upper).upper : infinity};
  if (z.upper <= -quarter.lower || z.lower >= quarter.lower) return a;
  return intersection(a, inside);
}

/// {a ∈ [a] : φ(a) ∈ [z]} where the inverse of φ is defined on [domain] and encloses by `inverse`.
template <class Inverse>
Interval by_inverse(Interval z, Interval domain, Interval a, Inverse&& inverse) {
  z = intersection(z, domain);
  return z.is_empty() ? no_number : intersection(a, inverse(z));
}

}  // namespace

Interval factor_of(Interval z, Interval b, Interval a) {
  if (!b.contains(0)) return intersection(a, z / b);
  if (z.contains(0)) return a;
  // z ≠ 0, so that b ≠ 0: the quotients are beyond two gaps' ends.
  const Interval size = z.lower > 0 ? z : -z;
  const bool is_negative = z.upper < 0;
  const Interval by_plus =
      b.upper > 0 ? Interval{(size / Interval{b.upper, b.upper}).lower, infinity} : no_number;
  const Interval by_minus =
      b.lower < 0 ? Interval{-infinity, -(size / Interval{-b.lower, -b.lower}).lower} : no_number;
  const auto turned = [&](Interval x) { return is_negative && !x.is_empty() ? -x : x; };
  return hull_of_parts(a, turned(by_plus), turned(by_minus));
}

Interval operand_of(const Node& node, Interval z, Interval a, Rounding rounding) {
  switch (node.operation) {
    case Operation::negate:
      return intersection(a, -z);
    case Operation::power:
      return operand_of_power(z, node.number, a, rounding);
    case Operation::real_power:
      if (node.value.contains(0)) return a;
      return by_inverse(z, positive, intersection(a, positive),
                        [&](Interval y) { return el::power(y, one / node.value, rounding); });
    case Operation::square_root:
      return by_inverse(z, positive, a, [](Interval y) { return el::power(y, 2); });
    case Operation::exponential:
      if (z.upper <= 0) return no_number;
      return by_inverse(z, positive, a, [&](Interval y) { return el::log(y, rounding); });
    case Operation::logarithm:
      return intersection(a, el::exp(z, rounding));
    case Operation::sine:
      return operand_of_sine(z, a, rounding);
    case Operation::cosine:
      return operand_of_cosine(z, a, rounding);
    case Operation::tangent:
      return operand_of_tangent(z, a, rounding);
    case Operation::arcsine: {
      const double quarter = (0.5 * el::pi).upper;
      return by_inverse(z, {-quarter, quarter}, a,
                        [&](Interval y) { return el::sin(y, rounding); });
    }
    case Operation::arccosine:
      return by_inverse(z, {0, el::pi.upper}, a, [&](Interval y) { return el::cos(y, rounding); });
    case Operation::arctangent:
      return operand_of_arctangent(z, a, rounding);
    case Operation::absolute_value:
      return of_magnitude(z, a);
    default:
      return a;
  }
}

Interval operand_of_minimum(Interval z, Interval b, Interval a) {
  const double upper = b.lower > z.upper ? z.upper : infinity;
  return intersection(a, {z.lower, upper});
}

}  // namespace cordon::formulas
