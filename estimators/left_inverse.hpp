// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/types.hpp"

namespace cordon::estimators {

/// The pseudo-inverse K⁺ = (KᵀK)⁻¹Kᵀ of a matrix with full column rank, each entry to the last
/// digits of its own: computed with 50 digits, for up to 100 columns. A singular value
/// decomposition leaves 1e-16 of the largest entries where there is 0, by which states, inputs and
/// faults of large size act on small ones that they have nothing to do with. Entries of less than
/// 1e-25 of the largest of their row, each times the norm of its row of K, are 0. Beyond 100
/// columns, and where KᵀK has no Cholesky factor, linalg::pseudo_inverse. `rest` (may be null)
/// becomes I - K K⁺, likewise. O(n² m) on long numbers, O(n m²) for `rest`.
Matrix left_inverse(const Matrix& K, Matrix* rest = nullptr);

}  // namespace cordon::estimators
