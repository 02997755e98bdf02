// SPDX-License-Identifier: GPL-3.0-or-later
// Questions about a set in exchange form, answered in rational arithmetic: the doubles are taken as
// the numbers they are. Slower by orders of magnitude than set_questions.hpp; used where a claim is
// checked and where rounding leaves a question open.
#pragma once

#include <vector>

#include "cordon/core/line_form.hpp"
#include "cordon/core/rounding.hpp"

namespace cordon::exact {

/// X = ∅? Always `yes` or `no`.
/// All functions here: Errc::dimension and Errc::not_finite for operands that do not fit,
/// Errc::unsupported above `max_columns` lines and generators, `max_rows` constraints or a product
/// columns · rows² of `max_work` (with the numbers in the message). No lock, any number of threads.
/// Bounded dual simplex method on a fraction-free tableau, started from the floating-point solver's
/// basis: milliseconds for tens of columns and ordinary numbers, seconds at the limit; numbers
/// spread over hundreds of decades take a hundred times as long.
Answer is_empty(const LineForm& X);

/// x ∈ X? Always `yes` or `no`.
Answer contains(const LineForm& X, VectorIn x);

/// h_X(d) = sup{dᵀx : x ∈ X} between two neighbouring doubles (one, if it is a double); (+inf,
/// +inf) if unbounded, (-inf, -inf) if X is empty.
Interval support(const LineForm& X, VectorIn d);

/// A basis of the directions in which X is unbounded, if it is not empty: {Mδ : Sδ = 0}, eliminated
/// exactly and rounded at the end. The largest entry of every column is in [1/2, 2). No limit of
/// size: it is elimination alone, O(m²l + l²n) on fractions.
Matrix lineality_space(const LineForm& X);

/// max{cᵀx : K x = r, 0 ≤ x_j ≤ 2^bits_j} between two neighbouring doubles; (-inf, -inf) if there
/// is no such x. One entry of `bits` per column of K, and products of K's entries with 2^(bits_j -
/// 1) must be doubles: else Errc::invalid.
Interval maximum(VectorIn c, MatrixIn K, VectorIn r, const std::vector<int>& bits);

inline constexpr Index max_columns = 2000, max_rows = 100, max_work = 2'000'000;

}  // namespace cordon::exact
