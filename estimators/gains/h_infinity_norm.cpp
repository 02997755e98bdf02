// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/h_infinity_norm.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/invariant/schur.hpp"

namespace cordon::estimators {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double gap = 1e-9;
constexpr int most_frequencies = 20'000;
constexpr int first_intervals = 16;

/// What is known at one frequency: σ₁(H), ‖T‖ and the relative error of σ₁ that rounding can have made.
struct Value {
  double omega = 0, sigma = infinite, spread = infinite, error = 0;
};

double largest_singular_value(const Matrix& A) {
  const Vector values = linalg::symmetric_eigen(linalg::product(A, A.transpose())).values;
  return values.size() == 0 ? 0.0 : std::sqrt(std::max(0.0, values[values.size() - 1]));
}

/// X + iY as the real matrix [X -Y; Y X], which has the same singular values, each twice.
Value value_at(const Matrix& A, const Matrix& B, double omega) {
  const Index n = A.rows(), m = B.cols();
  Matrix M(2 * n, 2 * n), right(2 * n, 2 * (n + m));
  const Matrix X = Matrix::Identity(n, n) - std::cos(omega) * A, Y = std::sin(omega) * A;
  M << X, -Y, Y, X;
  right.setZero();
  right.leftCols(2 * n).setIdentity();
  right.block(0, 2 * n, n, m) = B;
  right.block(n, 2 * n + m, n, m) = B;
  const std::optional<Matrix> solved = linalg::solve(M, right);
  if (!solved || !solved->allFinite()) return {omega};
  const Matrix T = solved->leftCols(2 * n) - Matrix::Identity(2 * n, 2 * n);
  Value value{omega, largest_singular_value(solved->rightCols(2 * m)), largest_singular_value(T)};
  value.error = 16.0 * static_cast<double>(n + 1) * std::numeric_limits<double>::epsilon() * (1 + M.norm()) * (1 + value.spread);
  return value;
}

struct Interval {
  Value from, to;
  double upper = infinite;
  bool operator<(const Interval& other) const { return upper < other.upper; }
};

Interval interval(const Value& from, const Value& to) {
  Interval made{from, to};
  const double h = to.omega - from.omega, spread = std::max(from.spread, to.spread), sigma = std::max(from.sigma, to.sigma);
  const double shrink = 1 - h / 2 * spread * (1 + 1e-9);
  if (!std::isfinite(sigma) || !(shrink > 0)) return made;
  const double grown = spread / shrink;
  made.upper = (sigma + grown * (1 + 2 * grown) * (sigma / shrink) * h * h / 8) * (1 + std::max(from.error, to.error));
  return made;
}

}  // namespace

NormBounds h_infinity_norm(MatrixIn A, MatrixIn B) {
  if (A.rows() != A.cols() || B.rows() != A.rows()) throw Error(Errc::dimension, "A must be square, B of as many rows");
  if (!B.allFinite()) throw Error(Errc::not_finite, "the norm needs finite entries");
  const Answer schur = invariant::is_schur(A);
  if (schur != Answer::yes) return {schur == Answer::no ? infinite : 0, infinite};
  if (B.size() == 0 || B.isZero(0)) return {0, 0};
  const double size = B.cwiseAbs().maxCoeff();  // extreme sizes would overflow when squared
  const Matrix scaled = B / size;

  double lower = 0;
  const auto evaluate = [&](double omega) {
    const Value value = value_at(A, scaled, omega);
    if (std::isfinite(value.sigma)) lower = std::max(lower, value.sigma * (1 - std::min(1.0, value.error)));
    return value;
  };
  std::priority_queue<Interval> open;
  Value from = evaluate(0);
  for (int i = 1; i <= first_intervals; ++i) {
    const Value to = evaluate(std::numbers::pi * i / first_intervals);
    open.push(interval(from, to));
    from = to;
  }
  for (int count = first_intervals + 1; count < most_frequencies && open.top().upper > lower * (1 + gap); ++count) {
    const Interval widest = open.top();
    const double middle = (widest.from.omega + widest.to.omega) / 2;
    if (!(widest.from.omega < middle && middle < widest.to.omega)) break;
    open.pop();
    const Value between = evaluate(middle);
    open.push(interval(widest.from, between));
    open.push(interval(between, widest.to));
  }
  return {lower * size, open.top().upper * size};
}

}  // namespace cordon::estimators
