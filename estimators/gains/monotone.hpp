// SPDX-License-Identifier: GPL-3.0-or-later
// Gains that make A - L C monotone, A - L C ≥ 0 in every entry, and stable.
#pragma once

#include <optional>

#include "gains/gain_form.hpp"
#include "gains/obstacle.hpp"

namespace cordon::estimators {

/// Why no L makes A - L C monotone and stable, or nothing where no reason was found. Three of them,
/// in this order:
///   a column j of C is zero and A(i,j) < 0;
///   μ ≥ 0 with C μ = 0 and A_i μ < 0, so that (A - L C)_i μ < 0 for every L;
///   x ≥ 0, x ≠ 0 and y_i ≥ 0 with C (x - y_i) = 0 and A_i (x - y_i) ≥ x_i, so that (A - L C) x ≥ x
///   for every monotone A - L C.
/// The vectors come from linear programs, equations to 1e-10 of their terms, A_i μ < 0 by 1e-8 of
/// them. `no` where the same programs have a solution in rational arithmetic, and `unknown` where
/// they have one but for rounding or are too large for it.
std::optional<Obstacle> no_monotone_gain(const Matrix& A, const Matrix& C);

/// The same for A - L 𝒞 of gain_form.hpp. What is proven of a filter is so of the product C̄ A as it
/// is, not as it is rounded; where that is too much, the answer is `unknown`.
std::optional<Obstacle> no_monotone_gain(const LinearModel& model, GainForm form);

/// L with entries of A - L C that are negative by rounding (1e-9 of the largest of A) raised to 0
/// where a small change of L can do so; other negative entries stay.
Matrix raised_to_monotone(const Matrix& A, const Matrix& C, Matrix L);

/// The same for the gain nearest to L, row by row, with A - L C ≥ 0, where a linear program finds
/// it: for gains of solvers.
Matrix made_monotone(const Matrix& A, const Matrix& C, Matrix L);

/// A - L C ≥ 0 up to 1e-12 of its terms.
bool is_monotone(const Matrix& A, const Matrix& C, const Matrix& L);

}  // namespace cordon::estimators
