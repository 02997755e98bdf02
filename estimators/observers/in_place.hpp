// SPDX-License-Identifier: GPL-3.0-or-later
// Products into matrices that an observer keeps from step to step: the same numbers as those of linalg, without memory for a
// result where small maps meet and shapes stay.
#pragma once

#include "cordon/core/linalg.hpp"
#include "cordon/core/vectors.hpp"

namespace cordon::estimators {

/// C = A B; C is neither A nor B.
template <class Result>
void product(MatrixIn A, MatrixIn B, Result& C) {
  if (A.cols() == 0) {
    C.setZero(A.rows(), B.cols());
  } else if (vectors::is_small(A)) {
    C.resize(A.rows(), B.cols());
    vectors::small_product(A, B, C);
  } else {
    C = linalg::product(A, B);
  }
}

/// K = A Aᵀ.
inline void gram(MatrixIn A, Matrix& K) {
  if (A.rows() <= 6) {
    vectors::small_gram(A, K);
  } else {
    K = linalg::gram(A);
  }
}

}  // namespace cordon::estimators
