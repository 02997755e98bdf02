// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/line_form.hpp"

namespace cordon::sets {

/// How constraints are prepared before they are scored.
struct ConstraintElimination {
  /// Tighten the factors' bounds first, [-1,1] → [ξᴸ, ξᵁ], and rescale generators to them.
  /// [Scott2016, sec. 4.2]
  bool rescale = false;
  /// Bring the rows into Gauss-Jordan form before scoring.
  bool gauss_jordan = false;
};

/// A set and whether it equals the one it was made from (up to rounding).
struct Reduced {
  LineForm set;
  bool exact = true;
};

/// Encloses X = {c + Mδ + Gξ : ‖ξ‖∞ ≤ 1, Aξ = b} (S = 0) by a set with at most `max_constraints`
/// rows. [Scott2016, sec. 4.2]
///
/// One row after another is solved for a factor ξ_j and dropped, which forgets |ξ_j| ≤ 1. The
/// factor is the one with the smallest
///   r_j² (‖D G P e_j‖² / P_jj + w) / P_jj,   P = H - (AH)ᵀ(AHAᵀ)⁻¹(AH),  H = (I + GᵀG)⁻¹,  and w a
///   millionth,
/// with r_j = max(0, max|ρ_j| - 1) how far the rows would let ξ_j go beyond its bound (ρ_j: the
/// interval that they allow) and D the inverse widths of the set: d = r_j P e_j / P_jj is the least
/// change of (ξ, Gξ) that goes so far, ‖D G d‖ what it does to the state. [Scott2016] weighs ‖d‖² +
/// ‖G d‖² alike; on the published descriptor system that loses up to a factor of two in single
/// steps, where the state's part loses nothing. r_j = 0 loses nothing. One factorisation serves all
/// scores and is updated by rank-one terms. Rows that have become 0 = 0, or that cancelled to 1e-5
/// of their terms or less, are dropped; a row 0 = b ≠ 0 stays (X is ∅). Where what is left is flat,
/// `tolerances::product_noise` (1e-14) of the terms that it was computed from is added as factors,
/// for coordinates and rows. O(g (n + m)² + per eliminated row g (n + m)).
Reduced eliminate_constraints(const LineForm& X, Index max_constraints,
                              const ConstraintElimination& options = {});

}  // namespace cordon::sets
