// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of proofs in rational arithmetic, without a solver. Every double of the operands is taken
// as the number it is. What a certificate says only up to rounding is restored first, exactly:
// multipliers are moved onto their equations, a point onto its constraints. `false` says that this
// proof does not hold, not that its statement is wrong. Errors: Errc::dimension, Errc::not_finite
// for operands that do not fit. O((l + m)² (l + g + m)) rational operations.
#pragma once

#include <optional>

#include "cordon/core/answer.hpp"
#include "cordon/core/line_form.hpp"

namespace cordon {

/// X = ∅, by y with Sᵀy = 0 and bᵀy > ‖Aᵀy‖₁ (kind `farkas`).
bool proves_empty(const LineForm& X, const Certificate& why);
/// Does that check take no more than about a second?
bool is_quickly_proven_empty(const LineForm& X);
/// X ≠ ∅, by a solution (δ, ξ) of Sδ + Aξ = b with ‖ξ‖∞ ≤ 1 (kind `point`; `structure` for a set
/// without constraints).
bool proves_not_empty(const LineForm& X, const Certificate& why);

/// x ∈ X, and x ∉ X: by the same proofs for the rows Sδ + Aξ = b, Mδ + Gξ = x - c.
bool proves_contains(const LineForm& X, VectorIn x, const Certificate& why);
bool proves_excludes(const LineForm& X, VectorIn x, const Certificate& why);

/// X ∩ Y = ∅, and ≠ ∅: by the same proofs for the rows of X, those of Y, and Mδ_X + Gξ_X - Mδ_Y -
/// Gξ_Y = c_Y - c_X.
bool proves_disjoint(const LineForm& X, const LineForm& Y, const Certificate& why);
bool proves_meet(const LineForm& X, const LineForm& Y, const Certificate& why);

/// h_X(d) ≤ bound, by y with Sᵀy = Mᵀd and dᵀc + bᵀy + ‖Gᵀd - Aᵀy‖₁ ≤ bound (kind `dual`;
/// `structure` is y = 0; `farkas` if X = ∅).
bool proves_support(const LineForm& X, VectorIn d, double bound, const Certificate& why);

/// The bound that multipliers y prove, rounded up; nothing if no y nearby satisfies Sᵀy = Mᵀd (then
/// h_X(d) = +inf, or X = ∅).
std::optional<double> proven_support(const LineForm& X, VectorIn d, VectorIn y);

/// Has the recession space M ker S of a non-empty X more than 0? Decided by ranks, without a
/// certificate.
bool has_lineality(const LineForm& X);

}  // namespace cordon
