// SPDX-License-Identifier: GPL-3.0-or-later
// The questions of exact_questions.hpp about points and directions that are no doubles: vertices
// and facets of a Polytope.
#pragma once

#include "cordon/core/line_form.hpp"
#include "solvers/rational.hpp"

namespace cordon::exact {

/// x ∈ X ⊕ [-margin, margin], where each constraint of X holds within `slack` (of size m, or empty:
/// no slack)? For operands that fit; Errc::unsupported as in exact_questions.hpp.
bool contains(const LineForm& X, const rational::RationalVector& x, VectorIn margin,
              VectorIn slack = Vector());

/// h_X(d) itself.
struct Support {
  enum class Kind { empty, finite, unbounded } kind;
  rational::Rational value;  ///< if finite
};
Support support(const LineForm& X, const rational::RationalVector& d);

}  // namespace cordon::exact
