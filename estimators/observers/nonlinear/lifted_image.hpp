// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "cordon/core/line_form.hpp"
#include "observers/nonlinear/affine_rows.hpp"

namespace cordon::estimators {

/// Most generators that are lifted: they become half as many as their square.
inline constexpr Index most_lifted = 200;

/// The image of Z = {c + Gξ : Aξ = b, ‖ξ‖∞ ≤ 1} under rows of second order with their squares and
/// products kept, set ⊕ box(radius): with p = c - h, H̄ the middle of [H], Q = Gᵀ H̄ G and new
/// factors ζ_i = 2 ξ_i² - 1, ζ_ij = ξ_i ξ_j in [-1, 1],
///   F(h) + J p + ½ pᵀ H̄ p + ¼ Σ Q_ii + (J + pᵀ H̄) G ξ + ¼ Σ Q_ii ζ_i + Σ_{i<j} Q_ij ζ_ij,
/// radius ½ rᵀ rad[H] r and what is rounded; and, as products of equalities hold too, for r ≤ s
///   ½ Σ A_ri A_si ζ_i + Σ_{i<j} (A_ri A_sj + A_rj A_si) ζ_ij = b_r b_s - ½ Σ A_ri A_si.
/// h may be any point of the box, H̄ is symmetric. Sources: [Combastel2005] without constraints,
/// [Rego2020a] with them. Of g generators and m constraints it makes g (g + 3) / 2 and
/// m (m + 3) / 2, in O(rows g² dim + m² g²).
struct LiftedImage {
  LineForm set;
  Vector radius;
};

/// Over the last box of `function`. A row without bounded second derivatives, or nominal with
/// factors that reach further than those of `rows`, an enclosure over the same box, is that of
/// `rows`: where constraints cut most of the factors' box away, squares and products would grow
/// from step to step until rounding errors are as large as the set. `outward`: with the products of
/// constraints, each with a generator for its rounding. Without, they are left out: constraints of
/// nominal sets hold up to rounding errors, which their products, nearly dependent, do not keep
/// small, so that true states were lost. Nothing where Z has lines or more generators than
/// `most_lifted`, or numbers overflow.
std::optional<LiftedImage> lifted_image(const formulas::BoxEnclosure& function,
                                        const AffineRows& rows, const LineForm& Z, bool outward);

}  // namespace cordon::estimators
