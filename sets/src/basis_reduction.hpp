// SPDX-License-Identifier: GPL-3.0-or-later
// The reduction `yang_scott`: generators are absorbed one by one into a basis of large ones.
// [Yang2018, method 4]
#pragma once

#include "reduction_split.hpp"

namespace cordon::sets {

/// H with at most max_generators ≥ n columns around {Gξ}. Memory is kept by thread.
Matrix reduce_into_basis(MatrixIn G, Index max_generators);

/// The same as a proposal: what is kept, what is absorbed, and the basis.
ReductionSplit split_into_basis(MatrixIn G, Index max_generators);

}  // namespace cordon::sets
