// SPDX-License-Identifier: GPL-3.0-or-later
#include "elimination_scores.hpp"

#include <algorithm>
#include <cmath>

namespace cordon::sets {

namespace {

constexpr double dependent =
    1e-12;  ///< a row this near to the span of others adds nothing to the scores
constexpr double factor_weight =
    1e-6;  ///< of the change of the factors beside that of the state: decides ties

double* row(Rows& A, Index i) { return A.data() + i * A.cols(); }

/// Rows W of F become L⁻¹W, where L Lᵀ = K; the lower part of K is overwritten with L. Of the first
/// `constraints` rows only those count that are independent: tells which. The others have 1 on K's
/// diagonal beside what is their own, however much cancels. `before` receives K's diagonal.
void orthonormalise(Rows& F, Matrix& K, Index constraints, Vector& before,
                    std::vector<Index>& independent) {
  const Index m = K.rows(), width = F.cols();
  before = K.diagonal();
  independent.clear();
  for (Index k = 0; k < m; ++k) {
    double* const column = &K(0, k);
    const double least = dependent * before[k];
    if (k < constraints && !(column[k] > least && column[k] > 0)) continue;
    if (k >= constraints && !(column[k] > std::max(least, 1.0))) column[k] = std::max(least, 1.0);
    const double inverse = 1 / std::sqrt(column[k]);
    double* const made = row(F, k);
    for (Index j = 0; j < width; ++j) made[j] *= inverse;
    for (Index j = k; j < m; ++j) column[j] *= inverse;
    for (Index j = k + 1; j < m; ++j) {
      const double factor = column[j];
      if (factor == 0) continue;
      double* const to = &K(0, j);
      for (Index i = j; i < m; ++i) to[i] -= factor * column[i];
      vectors::add_multiple(width, -factor, made, row(F, j));
    }
    independent.push_back(k);
  }
}

}  // namespace

// With W = [A; G] and K = WWᵀ + [0 0; 0 I] it holds P = I - WᵀK⁻¹W, and the rows of G in K⁻¹W are G
// P.
void EliminationScores::take(const Rows& G, const Rows& A, const std::vector<Index>& live) {
  const Index n = G.rows(), m = static_cast<Index>(live.size()), width = G.cols();
  F_.resize(m + n, width);
  moved_.resize(n, width);
  Q_.resize(std::max(m, Index{1}), width);
  forgotten_ = 0;
  for (Index i = 0; i < m; ++i)
    std::copy_n(A.data() + live[static_cast<std::size_t>(i)] * width, width, row(F_, i));
  std::copy_n(G.data(), n * width, row(F_, m));
  take_row_gram(F_, K_);
  K_.diagonal().tail(n).array() += 1;
  orthonormalise(F_, K_, m, diagonal_, independent_);
  for (std::size_t k = 0; k < independent_.size(); ++k) {
    if (independent_[k] != static_cast<Index>(k))
      std::copy_n(row(F_, independent_[k]), width, row(F_, static_cast<Index>(k)));
  }
  rows_ = static_cast<Index>(independent_.size());
  for (Index i = n - 1; i >= 0; --i) {
    std::copy_n(row(F_, rows_ - n + i), width, row(moved_, i));
    for (Index k = i + 1; k < n; ++k)
      vectors::add_multiple(width, -K_(m + k, m + i), row(moved_, k), row(moved_, i));
    moved_.row(i) /= K_(m + i, m + i);
  }
  for (Index i = 0; i < n; ++i) {  // in units of the set's own width
    const double size = G.row(i).lpNorm<1>();
    if (size > 0) moved_.row(i) /= size;
  }
  diagonal_.setOnes(width);
  for (Index k = 0; k < rows_; ++k) {
    const double* const from = row(F_, k);
    for (Index j = 0; j < width; ++j) diagonal_[j] -= from[j] * from[j];
  }
  sum_squares_of_moves();
}

double EliminationScores::score(Index j, double reach) const {
  if (reach == 0) return 0;
  const double diagonal = std::max(diagonal_[j], 1e-15);
  return reach * reach * (moved_squares_[j] / diagonal + factor_weight) / diagonal;
}

void EliminationScores::forget(Index col) {
  const Index width = F_.cols();
  if (forgotten_ == Q_.rows()) Q_.conservativeResize(2 * forgotten_, Eigen::NoChange);
  double* const p = row(Q_, forgotten_);
  std::fill_n(p, width, 0.0);
  p[col] = 1;
  for (Index k = 0; k < rows_; ++k) vectors::add_multiple(width, -F_(k, col), row(F_, k), p);
  for (Index k = 0; k < forgotten_; ++k) vectors::add_multiple(width, Q_(k, col), row(Q_, k), p);
  const double rest = 1 - p[col];
  if (!(rest > 1e-14)) return;
  for (Index i = 0; i < moved_.rows(); ++i)
    vectors::add_multiple(width, moved_(i, col) / rest, p, row(moved_, i));
  sum_squares_of_moves();
  const double length = std::sqrt(rest);
  for (Index j = 0; j < width; ++j) {
    p[j] /= length;
    diagonal_[j] += p[j] * p[j];
  }
  ++forgotten_;
}

void EliminationScores::sum_squares_of_moves() {
  moved_squares_.setZero(moved_.cols());
  for (Index i = 0; i < moved_.rows(); ++i) {
    const double* const from = row(moved_, i);
    for (Index j = 0; j < moved_.cols(); ++j) moved_squares_[j] += from[j] * from[j];
  }
}

}  // namespace cordon::sets
