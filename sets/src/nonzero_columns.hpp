// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>

#include "cordon/core/types.hpp"

namespace cordon::sets {

inline bool is_zero_column(MatrixIn G, Index j) {
  const double* const column = G.data() + j * G.outerStride();
  for (Index i = 0; i < G.rows(); ++i) {
    if (column[i] != 0) return false;
  }
  return true;
}

inline Index count_nonzero_columns(MatrixIn G) {
  Index count = 0;
  for (Index j = 0; j < G.cols(); ++j) count += is_zero_column(G, j) ? 0 : 1;
  return count;
}

inline void take_nonzero_columns(MatrixIn G, Matrix& kept) {
  kept.resize(G.rows(), count_nonzero_columns(G));
  Index count = 0;
  for (Index j = 0; j < G.cols(); ++j) {
    if (!is_zero_column(G, j)) kept.col(count++) = G.col(j);
  }
}

inline Matrix nonzero_columns(MatrixIn G) {
  Matrix kept;
  take_nonzero_columns(G, kept);
  return kept;
}

/// The same of a matrix that is not needed any more.
inline Matrix without_zero_columns_of(Matrix G) {
  return count_nonzero_columns(G) == G.cols() ? std::move(G) : nonzero_columns(G);
}

}  // namespace cordon::sets
