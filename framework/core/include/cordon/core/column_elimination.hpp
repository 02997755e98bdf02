// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cordon/core/types.hpp"

namespace cordon {

/// Which columns of a computed matrix are independent, as far as their digits tell. Every entry
/// comes with the size of the terms that it cancelled from; one that is 1e-4 of them or less is no
/// pivot, since directions divided by it are known to few digits. O(rows · columns · kept).
struct ColumnElimination {
  ColumnElimination(Matrix entries, Matrix sizes_of_terms);

  std::vector<Index> order;  ///< of the columns: the independent ones first
  Index kept = 0;            ///< how many of them there are

  /// Coordinates in which the columns that are left may have entries, be it by rounding.
  std::vector<Index> reached() const;

 private:
  bool find_pivot(Index& row, Index& col) const;
  void eliminate(Index row);

  Matrix columns_, terms_;
};

/// M, and behind it a unit vector for each of these coordinates.
Matrix with_unit_vectors(Matrix M, const std::vector<Index>& coordinates);

}  // namespace cordon
