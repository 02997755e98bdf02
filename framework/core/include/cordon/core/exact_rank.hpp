// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/types.hpp"

namespace cordon {

/// The rank of A, or of the exact product A B, their doubles taken as the numbers they are, modulo
/// the prime 2⁶¹ - 1: at most the exact rank, and less than it only where that prime divides every
/// minor of its size. Entries are finite. O(rows · columns · rank) products of integers, and those
/// of A B.
Index rank_modulo_prime(MatrixIn A);
Index product_rank_modulo_prime(MatrixIn A, MatrixIn B);

}  // namespace cordon
