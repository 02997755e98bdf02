// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "cordon/core/line_form.hpp"

namespace cordon::sets {

/// Constrained zonotope {c + Gξ : ‖ξ‖∞ ≤ 1, Aξ = b}, a convex polytope [Scott2016]. It is the line
/// zonotope without lines: `line_form` is a view of it as one, and every operation of
/// line_zonotope.hpp applied to forms without lines gives a form without lines.
struct ConstrainedZonotope {
  Vector c;
  Matrix G, A;
  Vector b;

  Index dim() const { return c.size(); }
  Index generators() const { return G.cols(); }
  Index constraints() const { return b.size(); }
};

LineForm line_form(const ConstrainedZonotope& Z);

/// X as a constrained zonotope: exact, lines are eliminated. Nothing if lines are left, as the set
/// is unbounded then (or ∅).
std::optional<ConstrainedZonotope> to_constrained_zonotope(const LineForm& X);

}  // namespace cordon::sets
