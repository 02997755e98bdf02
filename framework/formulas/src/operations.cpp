// SPDX-License-Identifier: GPL-3.0-or-later
#include "operations.hpp"

namespace cordon::formulas {

namespace {

using elementary::Domain;
namespace el = elementary;

/// Domain {x ≥ 0}, or {x > 0}.
Domain at_least_zero(Interval a, bool open) {
  if (open ? a.lower > 0 : a.lower >= 0) return Domain::all;
  return (open ? a.upper <= 0 : a.upper < 0) ? Domain::nowhere : Domain::part;
}

Domain without_zero(Interval a) {
  if (!a.contains(0)) return Domain::all;
  return a == Interval{0, 0} ? Domain::nowhere : Domain::part;
}

Domain within_one(Interval a) {
  if (a.lower >= -1 && a.upper <= 1) return Domain::all;
  return a.upper < -1 || a.lower > 1 ? Domain::nowhere : Domain::part;
}

/// aⁿ for n < 0 and 0 ∈ a.
Interval power_over_zero(Interval a, int n) {
  if (n % 2 == 0) return {el::power(point(a.magnitude()), n).lower, infinity};
  if (a.lower >= 0) return {el::power(point(a.upper), n).lower, infinity};
  if (a.upper <= 0) return {-infinity, el::power(point(a.lower), n).upper};
  return real_line;
}

Interval integer_power(Interval a, int n) {
  return n < 0 && a.contains(0) ? power_over_zero(a, n) : el::power(a, n);
}

/// 1/√(1 - a²)
Interval arcsine_slope(Interval a) {
  return el::reciprocal_of_positive(el::sqrt(intersection(one - el::power(a, 2), {0, 1})));
}

/// a (1 - a²)^-3/2 increases.
Interval arcsine_curvature(Interval a) {
  const auto at = [](double t) { return point(t) * el::power(arcsine_slope(point(t)), 3); };
  return {at(a.lower).lower, at(a.upper).upper};
}

Interval slope_of_absolute_value(Interval a) {
  if (a.lower > 0) return one;
  return a.upper < 0 ? -one : Interval{-1, 1};
}

/// On its two sides the operation has the same derivatives as elsewhere, which say nothing of how a
/// value on one side differs from one on the other.
bool has_pole(const Node& node, Interval a) {
  if (node.operation == Operation::power) return node.number < 0 && a.contains(0);
  return node.operation == Operation::tangent && el::tan_domain(a) != Domain::all;
}

}  // namespace

Domain domain_of(const Node& node, Interval a) {
  switch (node.operation) {
    case Operation::power:
      return node.number < 0 ? without_zero(a) : Domain::all;
    case Operation::real_power:
      return at_least_zero(a, node.value.lower <= 0);
    case Operation::square_root:
      return at_least_zero(a, false);
    case Operation::logarithm:
      return at_least_zero(a, true);
    case Operation::tangent:
      return el::tan_domain(a);
    case Operation::arcsine:
    case Operation::arccosine:
      return within_one(a);
    default:
      return Domain::all;
  }
}

Interval within_domain(const Node& node, Interval a) {
  switch (node.operation) {
    case Operation::real_power:
    case Operation::square_root:
    case Operation::logarithm:
      return intersection(a, {0, infinity});
    case Operation::arcsine:
    case Operation::arccosine:
      return intersection(a, {-1, 1});
    default:
      return a;
  }
}

Interval range_of(const Node& node, Interval a, Interval b, Rounding rounding) {
  switch (node.operation) {
    case Operation::add:
      return a + b;
    case Operation::subtract:
      return a - b;
    case Operation::negate:
      return -a;
    case Operation::multiply:
      return a * b;
    case Operation::power:
      return integer_power(a, node.number);
    case Operation::real_power:
      return el::power(a, node.value, rounding);
    case Operation::square_root:
      return el::sqrt(a);
    case Operation::exponential:
      return el::exp(a, rounding);
    case Operation::logarithm:
      return el::log(a, rounding);
    case Operation::sine:
      return el::sin(a, rounding);
    case Operation::cosine:
      return el::cos(a, rounding);
    case Operation::tangent:
      return el::tan_domain(a) == Domain::all ? el::tan(a, rounding) : real_line;
    case Operation::arcsine:
      return el::asin(a, rounding);
    case Operation::arccosine:
      return el::acos(a, rounding);
    case Operation::arctangent:
      return el::atan(a, rounding);
    case Operation::absolute_value:
      return el::abs(a);
    case Operation::minimum:
      return el::min(a, b);
    case Operation::maximum:
      return el::max(a, b);
    case Operation::constant:
    case Operation::variable:
      break;
  }
  return real_line;
}

Interval first_derivative(const Node& node, Interval a, Interval value, Rounding rounding) {
  if (has_pole(node, a)) return real_line;
  switch (node.operation) {
    case Operation::negate:
      return -one;
    case Operation::power:
      return static_cast<double>(node.number) * integer_power(a, node.number - 1);
    case Operation::real_power:
      return node.value * el::power(a, node.value - one, rounding);
    case Operation::square_root:
      return el::reciprocal_of_positive(2.0 * value);
    case Operation::exponential:
      return value;
    case Operation::logarithm:
      return el::reciprocal_of_positive(a);
    case Operation::sine:
      return el::cos(a, rounding);
    case Operation::cosine:
      return -el::sin(a, rounding);
    case Operation::tangent:
      return one + el::power(value, 2);
    case Operation::arcsine:
      return arcsine_slope(a);
    case Operation::arccosine:
      return -arcsine_slope(a);
    case Operation::arctangent:
      return el::reciprocal_of_positive(one + el::power(a, 2));
    case Operation::absolute_value:
      return slope_of_absolute_value(a);
    default:
      return real_line;
  }
}

Interval second_derivative(const Node& node, Interval a, Interval value, Rounding rounding) {
  if (has_pole(node, a)) return real_line;
  switch (node.operation) {
    case Operation::negate:
      return {0, 0};
    case Operation::power:
      return static_cast<double>(node.number) * (node.number - 1.0) *
             integer_power(a, node.number - 2);
    case Operation::real_power:
      return node.value * (node.value - one) * el::power(a, node.value - point(2), rounding);
    case Operation::square_root:
      return -el::reciprocal_of_positive(4.0 * (a * value));
    case Operation::exponential:
      return value;
    case Operation::logarithm:
      return -el::reciprocal_of_positive(el::power(a, 2));
    case Operation::sine:
    case Operation::cosine:
      return -value;
    case Operation::tangent:
      return 2.0 * (value * (one + el::power(value, 2)));
    case Operation::arcsine:
      return arcsine_curvature(a);
    case Operation::arccosine:
      return -arcsine_curvature(a);
    case Operation::arctangent:
      return el::atan_second_derivative(a);
    case Operation::absolute_value:
      return a.contains(0) ? real_line : Interval{0, 0};
    default:
      return real_line;
  }
}

}  // namespace cordon::formulas
