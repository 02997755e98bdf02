// SPDX-License-Identifier: GPL-3.0-or-later
// Certified questions about a set in exchange form: what every representation's answers rest on.
#pragma once

#include <vector>

#include "cordon/core/answer.hpp"
#include "cordon/core/box.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/core/line_form.hpp"

namespace cordon {

/// Is X empty? Lines are eliminated first; then a Farkas vector or a repaired point of the
/// constraints in ξ decides.
Answer is_empty(const LineForm& X, Certificate* why = nullptr);

/// x ∈ X? `no` by a Farkas vector of {Mδ + Gξ = x - c, Sδ + Aξ = b}, `yes` by a repaired point.
Answer contains(const LineForm& X, VectorIn x, Certificate* why = nullptr);

/// Upper bound of h_X(d) = sup{dᵀx : x ∈ X}: tight up to rounding when the solver succeeds, sound
/// in any case; +inf if unbounded or if nothing better is proven, -inf if X is proven empty.
double support(const LineForm& X, VectorIn d, Certificate* why = nullptr);

/// A value that dᵀx attains or exceeds for some x proven to lie in X; -inf without a proof. Never
/// above h_X(d).
double lower_support(const LineForm& X, VectorIn d);

/// Smallest box that contains X, each bound a certified support value; ±inf in unbounded
/// coordinates; Box::empty if X is proven empty (n = 0: see `is_empty`). `why` receives two proofs
/// per coordinate: of the upper and of the lower bound.
Box interval_hull(const LineForm& X, std::vector<Certificate>* why = nullptr);

/// Lineality space {x : X + x = X} of a non-empty X: an orthonormal basis (n×r) of M ker S.
Matrix lineality_space(const LineForm& X);

/// Bounded? `yes` if no line is left after elimination (or X is empty), `no` if X is proven
/// non-empty and lines are left.
Answer is_bounded(const LineForm& X);

/// X ∩ Y = ∅? By emptiness of the exact intersection.
Answer is_disjoint(const LineForm& X, const LineForm& Y, Certificate* why = nullptr);

/// X ⊆ Y? `no` by a direction d with a point of X proven beyond h_Y(d). `yes` if X is proven empty,
/// or by the facets of Y's lifted zonotope {(Gξ, Aξ)} where there are at most `max_facets`
/// candidates. Else `unknown`.
Answer is_subset(const LineForm& X, const LineForm& Y, Certificate* why = nullptr);

}  // namespace cordon
