// SPDX-License-Identifier: GPL-3.0-or-later
#include "elimination_scores.hpp"

#include <algorithm>
#include <cmath>

#include "small_products.hpp"

namespace cordon::sets {

namespace {

constexpr double dependent = 1e-12;     ///< a row this near to the span of others adds nothing to the scores
constexpr double factor_weight = 1e-6;  ///< of the change of the factors beside that of the state: decides ties

/// W L⁻ᵀ for the independent ones among the columns of W, where L Lᵀ = K is the Gram matrix of these in some metric. K is
/// overwritten.
Matrix orthonormalised(Matrix W, Matrix K) {
  const Index m = K.rows();
  const Vector before = K.diagonal();
  Index made = 0;
  for (Index k = 0; k < m; ++k) {
    if (!(K(k, k) > dependent * before[k]) || !(K(k, k) > 0)) continue;
    const double pivot = std::sqrt(K(k, k));
    K.col(k).tail(m - k) /= pivot;
    W.col(made) = W.col(k) / pivot;
    for (Index j = k + 1; j < m; ++j) {
      const double factor = K(j, k);
      if (factor == 0) continue;
      K.col(j).tail(m - j) -= factor * K.col(k).tail(m - j);
      W.col(j) -= factor * W.col(made);
    }
    ++made;
  }
  return W.leftCols(made);
}

}  // namespace

EliminationScores::EliminationScores(const Matrix& G, const RowMatrix& A, const std::vector<Index>& live)
    : Q_(G.cols(), 0), moved_(G.transpose()) {
  const Index n = G.rows();
  Matrix K = inner_products(moved_, moved_);
  K.diagonal().array() += 1;
  const Matrix outputs = orthonormalised(moved_, std::move(K));
  const Matrix rows = A(live, Eigen::all).transpose();
  Matrix W = rows;  // H Aᵀ
  subtract_product(outputs, inner_products(outputs, rows), W);
  K = inner_products(rows, W);
  const Matrix constraints = orthonormalised(std::move(W), std::move(K));
  F_.resize(G.cols(), outputs.cols() + constraints.cols());
  F_ << outputs, constraints;
  diagonal_ = 1 - F_.rowwise().squaredNorm().array();
  for (Index i = 0; i < n; ++i) {  // in units of the set's own width
    const double width = moved_.col(i).lpNorm<1>();
    if (width > 0) moved_.col(i) /= width;
  }
  subtract_product(F_, inner_products(F_, moved_), moved_);
  moved_squares_ = moved_.rowwise().squaredNorm();
}

double EliminationScores::score(Index j, double reach) const {
  if (reach == 0) return 0;
  const double diagonal = std::max(diagonal_[j], 1e-15);
  return reach * reach * (moved_squares_[j] / diagonal + factor_weight) / diagonal;
}

void EliminationScores::forget(Index col) {
  Vector p = -(F_ * F_.row(col).transpose());
  if (Q_.cols() > 0) p += Q_ * Q_.row(col).transpose();
  p[col] += 1;
  const double rest = 1 - p[col];
  if (!(rest > 1e-14)) return;
  const Vector shift = moved_.row(col).transpose() / rest;
  for (Index i = 0; i < shift.size(); ++i) moved_.col(i) += shift[i] * p;
  moved_squares_ = moved_.rowwise().squaredNorm();
  Q_.conservativeResize(Eigen::NoChange, Q_.cols() + 1);
  Q_.col(Q_.cols() - 1) = p / std::sqrt(rest);
  diagonal_.array() += Q_.col(Q_.cols() - 1).array().square();
}

}  // namespace cordon::sets
