// SPDX-License-Identifier: GPL-3.0-or-later
// One operation over intervals: domain, range, and the ranges of its derivatives by its operand.
#pragma once

#include <algorithm>

#include "cordon/formulas/elementary.hpp"
#include "cordon/formulas/expression.hpp"

namespace cordon::formulas {

inline constexpr Interval one{1, 1};
inline Interval point(double x) { return {x, x}; }
/// Rounded; within the interval.
inline double middle(Interval x) {
  return std::clamp(0.5 * x.lower + 0.5 * x.upper, x.lower, x.upper);  // halves may underflow
}

/// Where the first operand `a` stands to the domain of the operation.
elementary::Domain domain_of(const Node& node, Interval a);

/// The part of `a` in the closure of the domain; a hull where that is in two parts. Empty if there
/// is none.
Interval within_domain(const Node& node, Interval a);

/// The range of the operation over operands of its domain's closure; the real line where it is not
/// bounded on one side only by more than that. Not for constants and variables.
Interval range_of(const Node& node, Interval a, Interval b, Rounding rounding);

/// The ranges of φ' and φ'' of an operation with one operand; `value`: its range. Not bounded where
/// the derivative is not, the real line where there is none or φ has a pole in `a`: what they are
/// used for, that φ rises, is convex, or differs by so much at most, is then wrong.
Interval first_derivative(const Node& node, Interval a, Interval value, Rounding rounding);
Interval second_derivative(const Node& node, Interval a, Interval value, Rounding rounding);

}  // namespace cordon::formulas
