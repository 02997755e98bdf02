// SPDX-License-Identifier: GPL-3.0-or-later
// Linear programs of many rows with few entries each, in proposals.
#pragma once

#include <vector>

#include "cordon/solvers/lp.hpp"

namespace cordon {

/// minimise costᵀ x subject to row_lower ≤ A x ≤ row_upper, lower ≤ x ≤ upper. Infinite may be
/// bounds only: -inf below, +inf above.
struct SparseProgram {
  struct Entry {
    Index row, col;
    double value;
  };
  Vector cost;
  std::vector<Entry> entries;  ///< of A, each place at most once
  Vector row_lower, row_upper;
  Vector lower, upper;
};

/// By the dual simplex method, what is redundant taken out before; otherwise where that fails. `y`:
/// a multiplier per row, by how much the optimum grows with the row's bound. Throws
/// Errc::dimension, Errc::not_finite and Errc::invalid for broken programs.
LinearProgram::Solution minimize(const SparseProgram& program, double seconds);

}  // namespace cordon
