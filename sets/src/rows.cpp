// SPDX-License-Identifier: GPL-3.0-or-later
#include "rows.hpp"

namespace cordon::sets {

namespace {

/// So many multiplications that it pays to prepare for them.
constexpr Index many = 40000;

const double* row(const Rows& A, Index i) { return A.data() + i * A.cols(); }

}  // namespace

Rows padded_rows(MatrixIn A) {
  Rows B;
  take_padded_rows(A, B);
  return B;
}

void take_padded_rows(MatrixIn A, Rows& B) {
  const Index m = A.rows(), g = A.cols(), width = vectors::padded(g);
  B.resize(m, width);
  for (Index i = 0; i < m; ++i) {
    double* const to = B.data() + i * width;
    const double* const from = A.data() + i;
    for (Index j = 0; j < g; ++j) to[j] = from[j * A.outerStride()];
    for (Index j = g; j < width; ++j) to[j] = 0;
  }
}

Matrix row_gram(const Rows& A) {
  Matrix K;
  take_row_gram(A, K);
  return K;
}

void take_row_gram(const Rows& A, Matrix& K) {
  const Index m = A.rows();
  K.resize(m, m);
  if (A.size() * m > many) {
    K.setZero();
    K.selfadjointView<Eigen::Lower>().rankUpdate(A);
    K.triangularView<Eigen::StrictlyUpper>() = K.transpose();
    return;
  }
  for (Index j = 0; j < m; ++j) {
    for (Index i = j; i < m; ++i) K(i, j) = K(j, i) = vectors::dot(A.cols(), row(A, i), row(A, j));
  }
}

}  // namespace cordon::sets
