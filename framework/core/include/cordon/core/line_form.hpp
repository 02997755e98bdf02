// SPDX-License-Identifier: GPL-3.0-or-later
// The exchange form of all representations, and the set operations that are exact block matrices on
// it.
#pragma once

#include <span>
#include <string>

#include "cordon/core/answer.hpp"
#include "cordon/core/box.hpp"
#include "cordon/core/types.hpp"

namespace cordon {

/// Constrained line-and-generator form {c + Mδ + Gξ : δ ∈ Rˡ, ‖ξ‖∞ ≤ 1, Sδ + Aξ = b} (a line
/// zonotope) [Rego2025, (5)]. Shapes: c n, M n×l, G n×g, S m×l, A m×g, b m. A box, a zonotope and a
/// constrained zonotope are the special cases with fewer blocks. The recession cone is M ker S, a
/// subspace: half-spaces and half-lines are not representable. Canonical ∅: one row 0·ξ = 1.
struct LineForm {
  Matrix M, G;
  Vector c;
  Matrix S, A;
  Vector b;

  Index dim() const { return c.size(); }
  Index lines() const { return M.cols(); }
  Index generators() const { return G.cols(); }
  Index constraints() const { return b.size(); }
};

/// Refuses blocks whose shapes do not fit (Errc::dimension) and NaN or infinite entries
/// (Errc::not_finite). `what` names the set in the message.
void check(const LineForm& X, const std::string& what);

LineForm make_point(VectorIn x);                 ///< {x}
LineForm make_space(Index n);                    ///< Rⁿ
LineForm make_empty(Index n);                    ///< ∅ ⊂ Rⁿ
LineForm make_zonotope(VectorIn c, MatrixIn G);  ///< {c + Gξ : ‖ξ‖∞ ≤ 1}
/// Interval vector; a coordinate is bounded or free. Half-bounded or NaN bounds throw; an empty box
/// gives ∅. Centre and radius are rounded so that the box is enclosed.
LineForm make_box(const Box& box);
/// Does that form have exactly the bounds of the box, with nothing rounded?
bool is_exact_form_of(const Box& box);
LineForm make_strip(VectorIn rho, double d, double sigma);  ///< {x : |ρᵀx - d| ≤ σ}

/// T X + t; exact. T is m×n, t has size m. [Rego2025, (6)]
LineForm affine_map(const LineForm& X, MatrixIn T, VectorIn t);
/// X ⊕ Y = {x + y}; exact. [Rego2025, (7)]
LineForm minkowski_sum(const LineForm& X, const LineForm& Y);
/// X × Y; exact. [Rego2025, (9)]
LineForm cartesian_product(const LineForm& X, const LineForm& Y);
/// X ∩_R Y = {x ∈ X : R x ∈ Y}; exact. R is dim(Y)×dim(X). [Rego2025, (8)]
LineForm intersection(const LineForm& X, MatrixIn R, const LineForm& Y);
/// conv(X ∪ Y) for non-empty X, Y without lines: exact. With lines the result is the closure,
/// conv(X ∪ Y) ⊕ the sum of both lineality spaces (outer). X or Y with a row 0ᵀ(δ,ξ) = b ≠ 0 is ∅
/// and the other is returned. [Raghuraman2022, Thm 5]
LineForm convex_hull(const LineForm& X, const LineForm& Y);

/// One condition R x ∈ Z of `domain_of_maps`.
struct MapCondition {
  Matrix R;
  LineForm Z;
};
/// {x ∈ Rⁿ : R_i x ∈ Z_i for all i}, the domain of p linear mappings; exact. [Rego2025, (10)]
LineForm domain_of_maps(Index n, std::span<const MapCondition> conditions);

}  // namespace cordon
