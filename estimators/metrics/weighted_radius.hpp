// SPDX-License-Identifier: GPL-3.0-or-later
// Sizes of zonotopes in a weighted norm.
#pragma once

#include "cordon/core/types.hpp"

namespace cordon::estimators {

/// Most generators whose sign vectors are all tried: 2^(g-1) of them.
inline constexpr Index most_enumerated = 16;

/// ‖R‖_{F,W} = √tr(Rᵀ W R) of the generators R of a zonotope; 0 without generators. W is symmetric.
/// [Pourasghar2021, Definition 3]
double f_w_radius(MatrixIn R, MatrixIn W);

/// max ‖z - c‖²_W = max {bᵀ Rᵀ W R b : ‖b‖∞ ≤ 1} over a zonotope <c, R>. [Pourasghar2021,
/// Definition 4]
struct WRadius {
  double value = 0;
  bool exact = true;  ///< up to rounding; else an upper bound
};
/// W is symmetric and positive definite. Exact up to `most_enumerated` generators by trying all
/// vertices of the box, O(2^g n); beyond, for the zonotope that the reduction to that many
/// generators leaves, which contains the given one. Errors: Errc::unsupported for more states than
/// `most_enumerated` with more generators than that.
WRadius w_radius(MatrixIn R, MatrixIn W);

}  // namespace cordon::estimators
