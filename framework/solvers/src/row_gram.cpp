// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/row_gram.hpp"

#include <cmath>
#include <limits>

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"

namespace cordon {

namespace {

using rounding::gamma;
using rounding::up;

/// Of the mean eigenvalue: what is left of it after rounding counts as the smallest one.
constexpr double shift_share = 1e-8;
/// The shift makes solutions inexact; each correction makes up for nearly all that is left.
constexpr int most_corrections = 5;
constexpr double accurate = 1e-15;

}  // namespace

RowGram::RowGram(const Matrix& A, const Vector& b, const Vector& error)
    : A_(0, A.cols()), all_(A.rows()) {
  const Index g = A.cols();
  rows_.reserve(static_cast<std::size_t>(all_));
  for (Index i = 0; i < all_; ++i) {
    if (g > 0 && !A.row(i).isZero(0)) {
      rows_.push_back(i);
    } else if (b[i] != 0 || error[i] != 0) {
      return;
    }
  }
  const Index m = static_cast<Index>(rows_.size());
  if (m == 0) {
    smallest_ = 1;
    return;
  }
  const Vector scales = linalg::row_scales(A);
  A_.resize(m, g);
  of_rows_.resize(m, 4);
  for (Index k = 0; k < m; ++k) {
    const Index i = rows_[static_cast<std::size_t>(k)];
    double size = 0;
    for (Index j = 0; j < g; ++j) {
      A_(k, j) = scales[i] * A(i, j);
      if (std::abs(A_(k, j)) < rounding::tiny && A(i, j) != 0) return;  // scaling must be exact
      size += std::abs(A_(k, j));
    }
    scale()[k] = scales[i];
    right()[k] = scales[i] * b[i];
    unsure()[k] = scales[i] * error[i];
    reach()[k] = size * up(1 + 2 * gamma(g + 2));
  }
  factor();
}

/// |fl(K) - K| ≤ γ |A||A|ᵀ for K = A Aᵀ, whose 2-norm is at most the trace of K. A computed factor
/// L of K - s I has |LLᵀ - (K - sI)| ≤ γ |L||L|ᵀ with ‖|L||L|ᵀ‖₂ ≤ trace(LLᵀ) [Higham2002,
/// th. 10.3], and LLᵀ has no negative eigenvalue.
void RowGram::factor() {
  const Index g = A_.cols(), m = A_.rows();
  Matrix K = linalg::gram(A_);
  const double trace = K.trace(), shift = shift_share * trace / static_cast<double>(m);
  const double hidden = 1.01 * (gamma(g + 4) + gamma(m + 8) + 4 * rounding::unit) * trace +
                        static_cast<double>((g + m + 4) * m) * rounding::tiny;
  K.diagonal().array() -= shift;
  auto L = linalg::cholesky(K);
  if (!L || !L->allFinite() || !(shift > 2 * hidden)) return;
  L_ = std::move(*L);
  smallest_ = rounding::down(shift - hidden);
}

void RowGram::solve(Vector& v) const {
  L_.triangularView<Eigen::Lower>().solveInPlace(v);
  L_.transpose().triangularView<Eigen::Upper>().solveInPlace(v);
}

RowGram::Point RowGram::least_squares() const {
  Point point{Vector(A_.cols()), Vector::Zero(all_)};
  if (rows_.empty()) {
    point.xi.setZero();
    return point;
  }
  Vector y = Vector::Zero(A_.rows()), left = right();
  for (int round = 0; round < most_corrections; ++round) {
    solve(left);
    y += left;
    point.xi = linalg::transposed_product(A_, y);
    left = right() - linalg::product(A_, point.xi);
    if ((left.array().abs() <= accurate * (right().cwiseAbs() + reach()).array()).all()) break;
  }
  for (Index k = 0; k < y.size(); ++k)
    point.y[rows_[static_cast<std::size_t>(k)]] = scale()[k] * y[k];
  return point;
}

double RowGram::distance(const Vector& xi) const {
  if (rows_.empty()) return 0;
  const double largest = xi.size() ? xi.cwiseAbs().maxCoeff() : 0;
  if (!std::isfinite(largest)) return infinity;
  const double share = gamma(A_.cols() + 4),
               underflow = static_cast<double>(A_.cols() + 4) * rounding::tiny;
  const Vector image = linalg::product(A_, xi);
  double squares = 0;
  for (Index k = 0; k < image.size(); ++k) {
    const double gap =
        std::abs(right()[k] - image[k]) * (1 + 4 * rounding::unit) +
        share * (reach()[k] * largest + std::abs(right()[k])) * (1 + 8 * rounding::unit) +
        unsure()[k] * (1 + 4 * rounding::unit) + underflow;
    squares += gap * gap;
  }
  const double size = std::sqrt(squares / smallest_) * (1 + 4 * gamma(image.size() + 8));
  return up(size * (1 + 8 * rounding::unit) + rounding::tiny);
}

}  // namespace cordon
