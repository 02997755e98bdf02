// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/types.hpp"

namespace cordon {

/// The rank of A, its doubles taken as the numbers they are, modulo the prime 2⁶¹ - 1: at most the exact rank, and less than it
/// only where that prime divides every minor of its size. Entries are finite. O(rows · columns · rank) products of integers.
Index rank_modulo_prime(const Matrix& A);

}  // namespace cordon
