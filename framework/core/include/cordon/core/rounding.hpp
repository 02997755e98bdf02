// SPDX-License-Identifier: GPL-3.0-or-later
// Rigorous bounds of floating-point sums and products without changing the rounding mode: the value
// is computed in the ordinary way, then widened by an a-priori error bound [Higham2002, ch. 3].
// Valid for every order of summation, with and without fused operations; underflow is covered by an
// absolute term.
#pragma once

#include <limits>

#include "cordon/core/interval.hpp"
#include "cordon/core/types.hpp"

namespace cordon::rounding {

inline constexpr double unit = std::numeric_limits<double>::epsilon() / 2;  ///< unit roundoff 2⁻⁵³
inline constexpr double tiny =
    std::numeric_limits<double>::min();  ///< covers underflow, one per operation

/// γₙ = n u / (1 - n u), itself rounded up.
inline double gamma(Index n) {
  return up(static_cast<double>(n) * unit / (1 - static_cast<double>(n) * unit)) * (1 + 4 * unit);
}

Interval sum(VectorIn x);              ///< Σ x_i
Interval dot(VectorIn x, VectorIn y);  ///< xᵀy
Interval norm_1(VectorIn x);           ///< ‖x‖₁
inline Interval add(Interval a, Interval b) {
  return {down(a.lower + b.lower), up(a.upper + b.upper)};
}
inline Interval subtract(Interval a, Interval b) {
  return {down(a.lower - b.upper), up(a.upper - b.lower)};
}

/// Upper bound of |A B - fl(A B)|, entrywise, for fl in any order of summation.
Matrix product_error(MatrixIn A, MatrixIn B);

/// Upper bound of ‖g - Aᵀy‖₁ (g of size cols(A), y of size rows(A)).
double residual_norm_1(VectorIn g, MatrixIn A, VectorIn y);

}  // namespace cordon::rounding
