// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/h_infinity_norm.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/invariant/schur.hpp"

namespace cordon::estimators {

namespace {

constexpr double gap = 1e-9;
constexpr int most_frequencies = 20'000;
constexpr int first_intervals = 16;
constexpr double most_error = 0.1;  ///< of a value, relative; with more it counts as unknown

/// What is known at one frequency: σ₁(H), ‖T‖ and the relative error of both that rounding can have
/// made.
struct Value {
  double omega = 0, sigma = infinity, spread = infinity, error = 0;
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
  value.error = 16.0 * static_cast<double>(n + 1) * std::numeric_limits<double>::epsilon() *
                (1 + M.norm()) * (1 + value.spread);
  return value.error < most_error ? value : Value{omega};
}

struct Interval {
  Value from, to;
  double upper = infinity;   ///< of σ₁ in between
  double spread = infinity;  ///< of ‖(I - e^{-iω} A)⁻¹‖ in between
  bool operator<(const Interval& other) const { return upper < other.upper; }
};

Interval interval(const Value& from, const Value& to) {
  Interval made{from, to};
  const double h = to.omega - from.omega, spread = std::max(from.spread, to.spread),
               sigma = std::max(from.sigma, to.sigma);
  const double shrink = 1 - h / 2 * spread * (1 + 1e-9);
  if (!std::isfinite(sigma) || !(shrink > 0)) return made;
  const double grown = spread / shrink, trust = 1 - std::max(from.error, to.error);
  made.upper = (sigma + grown * (1 + 2 * grown) * (sigma / shrink) * h * h / 8) / trust;
  made.spread = (1 + grown) / trust;
  return made;
}

/// Matrices that are off by so much in the 2-norm.
struct Errors {
  double A = 0, B = 0;
};

double at_most(double sigma, double spread, Errors error) {
  if (!std::isfinite(sigma) || !(spread * error.A < 1 - gap)) return infinity;
  return (sigma + spread * error.B) / (1 - spread * error.A) * (1 + 16 * rounding::unit);
}

double at_least(const Value& value, Errors error) {
  if (!std::isfinite(value.sigma)) return 0;
  const double spread = (1 + value.spread) / (1 - value.error),
               sigma = value.sigma * (1 - value.error);
  return std::max(0.0, sigma - spread * error.B) / (1 + spread * error.A) *
         (1 - 16 * rounding::unit);
}

/// The intervals of [0, π], the one with the largest upper bound on top.
class Division {
 public:
  Division(Matrix A, Matrix B, Errors error) : A_(std::move(A)), B_(std::move(B)), error_(error) {
    Value from = evaluate(0);
    for (int i = 1; i <= first_intervals; ++i) {
      const Value to = evaluate(std::numbers::pi * i / first_intervals);
      open_.push(interval(from, to));
      from = to;
    }
  }

  void refine() {
    for (int count = first_intervals + 1;
         count < most_frequencies && open_.top().upper > largest_ * (1 + gap); ++count) {
      const Interval widest = open_.top();
      const double middle = (widest.from.omega + widest.to.omega) / 2;
      if (!(widest.from.omega < middle && middle < widest.to.omega)) break;
      open_.pop();
      const Value between = evaluate(middle);
      open_.push(interval(widest.from, between));
      open_.push(interval(between, widest.to));
    }
  }

  NormBounds bounds() {
    NormBounds known{lower_, 0};
    for (; !open_.empty(); open_.pop()) {
      known.upper = std::max(known.upper, at_most(open_.top().upper, open_.top().spread, error_));
    }
    return known;
  }

 private:
  Value evaluate(double omega) {
    const Value value = value_at(A_, B_, omega);
    if (std::isfinite(value.sigma)) largest_ = std::max(largest_, value.sigma * (1 - value.error));
    lower_ = std::max(lower_, at_least(value, error_));
    return value;
  }

  Matrix A_, B_;
  Errors error_;
  double largest_ = 0, lower_ = 0;
  std::priority_queue<Interval> open_;
};

}  // namespace

NormBounds h_infinity_norm(MatrixIn A, MatrixIn B, double A_error, double B_error) {
  if (A.rows() != A.cols() || B.rows() != A.rows())
    throw Error(Errc::dimension, "A must be square, B of as many rows");
  if (!B.allFinite()) throw Error(Errc::not_finite, "the norm needs finite entries");
  const Answer schur = invariant::is_schur(A);
  if (schur != Answer::yes) return {schur == Answer::no && A_error == 0 ? infinity : 0, infinity};
  if (B.size() == 0 || (B.isZero(0) && B_error == 0)) return {0, 0};
  const double largest = std::max(B.cwiseAbs().maxCoeff(), B_error);
  if (!std::isfinite(largest)) return {0, infinity};
  const int exponent = std::ilogb(largest);  // extreme sizes would overflow when squared
  const Matrix scaled = B.unaryExpr([&](double x) { return std::scalbn(x, -exponent); });
  Division division(A, scaled, {A_error, std::scalbn(B_error, -exponent)});
  division.refine();
  const NormBounds known = division.bounds();
  return {std::scalbn(known.lower, exponent), std::scalbn(known.upper, exponent)};
}

}  // namespace cordon::estimators
