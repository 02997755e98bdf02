// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/line_form.hpp"

namespace cordon::sets {

/// How constraints are prepared before they are scored.
struct ConstraintElimination {
  /// Tighten the factors' bounds first, [-1,1] → [ξᴸ, ξᵁ], and rescale generators to them. [Scott2016, sec. 4.2]
  bool rescale = false;
  /// Bring the rows into Gauss-Jordan form before scoring.
  bool gauss_jordan = false;
};

/// A set and whether it equals the one it was made from (up to rounding).
struct Reduced {
  LineForm set;
  bool exact = true;
};

/// Encloses X = {c + Mδ + Gξ : ‖ξ‖∞ ≤ 1, Aξ = b} (S = 0) by a set with at most `max_constraints` rows. [Scott2016, sec. 4.2]
///
/// One row after another is solved for a factor ξ_j and dropped, which forgets |ξ_j| ≤ 1. The factor is the one with the smallest
///   r_j² / P_jj,   P = H - (AH)ᵀ(AHAᵀ)⁻¹(AH),  H = (I + GᵀG)⁻¹,
/// the least squared change of (ξ, Gξ) that reaches as far as the rows would let ξ_j go beyond its bound: r_j = max(0, max|ρ_j| -
/// 1) with ρ_j the interval that the rows allow. r_j = 0 loses nothing. One factorisation serves all scores and is updated by
/// rank-one terms. Rows that have become 0 = 0 are dropped; a row 0 = b ≠ 0 stays (X is ∅). O(g (n + m)² + per eliminated row g
/// (n + m)).
Reduced eliminate_constraints(const LineForm& X, Index max_constraints, const ConstraintElimination& options = {});

}  // namespace cordon::sets
