// SPDX-License-Identifier: GPL-3.0-or-later
// Products of matrices of some dozens of numbers, as the steps of an observer have them: for these a plain loop is faster than
// preparing for large ones. Large ones go the usual way.
#pragma once

#include "cordon/core/types.hpp"

namespace cordon::sets {

/// AᵀB, without a copy of Aᵀ.
Matrix inner_products(const Matrix& A, const Matrix& B);

/// C -= A B.
void subtract_product(const Matrix& A, const Matrix& B, Matrix& C);

}  // namespace cordon::sets
