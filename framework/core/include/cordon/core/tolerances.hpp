// SPDX-License-Identifier: GPL-3.0-or-later
// The numerical policy: margins that several places share, each once, with its reason. Margins that
// one algorithm has for itself stand where it is.
#pragma once

namespace cordon::tolerances {

/// What a sum of products leaves of its terms is rounding: some ten operations of 1.1e-16 each, on
/// numbers that were rounded in the same way before. Smaller entries are zero.
inline constexpr double product_noise = 1e-14;

/// The same of a coefficient that several eliminations have gone over.
inline constexpr double elimination_noise = 1e-13;

/// Nominal rounding: a proof that a set is empty or a point outside must exceed this share of the
/// terms that it is made of, for these come from rounded operations themselves.
inline constexpr double proof_margin = 1e-10;

/// The terms of a proof count as at least this: below, shares of them and products underflow.
inline constexpr double smallest_terms = 1e-300;

/// Rows or columns are dependent where what is left of one is this share of the largest: numbers in
/// decimals that are rounded to doubles keep more, and matrices of measured plants are not known to
/// as many digits.
inline constexpr double rank = 1e-10;

/// Numbers of results are the same, or inside, up to this share of their size: what nominal
/// operations of a long run may add up to.
inline constexpr double reported = 1e-9;

}  // namespace cordon::tolerances
