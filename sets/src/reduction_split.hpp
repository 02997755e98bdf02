// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/sets/generator_reduction.hpp"

namespace cordon::sets {

/// What a reduction does with the columns of G.
struct ReductionSplit {
  Matrix kept;               ///< stay as they are
  Matrix replaced;           ///< the others
  Matrix basis;              ///< n×n: directions of the parallelotope that replaces them
  bool basis_first = false;  ///< its place in the result: later choices among equals depend on it
};

/// The split of `reduce_generators` for max_generators ≥ n: kept and basis have at most
/// max_generators columns together.
ReductionSplit split_generators(const Matrix& G, Index max_generators, GeneratorReduction method);

/// Half widths of the interval hull of {Gξ}, rounded up.
Vector enclosing_radii(MatrixIn G);

}  // namespace cordon::sets
