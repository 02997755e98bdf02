// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/types.hpp"

namespace cordon::invariant {

/// Positive sizes of the states under x⁺ = A x + d, |d| ≤ `size`: the first terms of Σ |Aᵏ| size.
/// In these units powers of A show their decay early. Coordinates that no disturbance reaches get a
/// share of the largest, or 1.
Vector decay_weights(MatrixIn A, VectorIn size);

}  // namespace cordon::invariant
