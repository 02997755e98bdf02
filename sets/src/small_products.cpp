// SPDX-License-Identifier: GPL-3.0-or-later
#include "small_products.hpp"

namespace cordon::sets {

namespace {

constexpr Index few = 4000;  ///< multiplications

}  // namespace

Matrix inner_products(const Matrix& A, const Matrix& B) {
  Matrix C(A.cols(), B.cols());
  if (A.size() * B.cols() <= few) {
    C.noalias() = A.transpose().lazyProduct(B);
  } else {
    C.noalias() = A.transpose() * B;
  }
  return C;
}

void subtract_product(const Matrix& A, const Matrix& B, Matrix& C) {
  if (A.size() * B.cols() <= few) {
    C.noalias() -= A.lazyProduct(B);
  } else {
    C.noalias() -= A * B;
  }
}

}  // namespace cordon::sets
