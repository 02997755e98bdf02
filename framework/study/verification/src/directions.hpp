// SPDX-License-Identifier: GPL-3.0-or-later
// Directions in which sets are compared where they are not compared whole.
#pragma once

#include <cstdint>

#include "cordon/core/types.hpp"

namespace cordon::verification {

/// ±e_i and `random` ones, as columns.
Matrix directions_of(Index n, std::int64_t random, std::uint64_t seed, Index k);

/// Are there directions that A takes to next to nothing, beside others or by entries that cancel,
/// and not to nothing?
bool hides_directions(const Matrix& A);

}  // namespace cordon::verification
