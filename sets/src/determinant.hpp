// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/types.hpp"

namespace cordon::sets {

/// det A by elimination with partial pivoting; A is overwritten. 1 for a 0×0 matrix. Allocates
/// nothing.
double determinant(Matrix& A);

}  // namespace cordon::sets
