// SPDX-License-Identifier: GPL-3.0-or-later
#include "left_inverse.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "cordon/core/linalg.hpp"

namespace cordon::estimators {

namespace {

using Long = boost::multiprecision::cpp_bin_float_50;

constexpr double noise = 1e-25;  ///< of numbers with 50 digits, conditions included

/// A table of long numbers, row by row.
class Table {
 public:
  Table(Index rows, Index cols)
      : cols_(cols), entries_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols)) {}
  Long& operator()(Index i, Index j) { return entries_[static_cast<std::size_t>(i * cols_ + j)]; }

 private:
  Index cols_;
  std::vector<Long> entries_;
};

/// The lower factor of KᵀK; nothing where that is singular to 40 digits.
std::optional<Table> factor(const Matrix& K) {
  const Index n = K.cols();
  Table L(n, n);
  for (Index j = 0; j < n; ++j) {
    for (Index i = j; i < n; ++i) {
      Long sum = 0;
      for (Index r = 0; r < K.rows(); ++r) {
        if (K(r, i) != 0 && K(r, j) != 0) sum += Long(K(r, i)) * K(r, j);
      }
      const Long whole = sum;
      for (Index k = 0; k < j; ++k) sum -= L(i, k) * L(j, k);
      if (i > j) {
        L(i, j) = sum / L(j, j);
      } else {
        if (!(sum > 1e-40 * whole)) return std::nullopt;
        L(j, j) = sqrt(sum);
      }
    }
  }
  return L;
}

/// (L Lᵀ)⁻¹ x.
void solve(Table& L, std::vector<Long>& x) {
  const auto n = static_cast<Index>(x.size());
  const auto at = [&](Index i) -> Long& { return x[static_cast<std::size_t>(i)]; };
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k < i; ++k) at(i) -= L(i, k) * at(k);
    at(i) /= L(i, i);
  }
  for (Index i = n - 1; i >= 0; --i) {
    for (Index k = i + 1; k < n; ++k) at(i) -= L(k, i) * at(k);
    at(i) /= L(i, i);
  }
}

Matrix without_rounding(const Matrix& inverse, const Matrix& K) {
  const Matrix shares = inverse.cwiseAbs() * K.rowwise().norm().asDiagonal();
  const Vector least = noise * shares.rowwise().maxCoeff();
  return (shares.array() <= least.replicate(1, K.rows()).array()).select(0.0, inverse);
}

/// e_r - K x, entries of less than 1e-25 left out.
Vector column_of_rest(const Matrix& K, const std::vector<Long>& x, Index r) {
  Vector rest(K.rows());
  for (Index i = 0; i < K.rows(); ++i) {
    Long sum = i == r ? 1 : 0;
    for (Index j = 0; j < K.cols(); ++j) {
      if (K(i, j) != 0) sum -= x[static_cast<std::size_t>(j)] * K(i, j);
    }
    const auto entry = static_cast<double>(sum);
    rest[i] = std::abs(entry) > noise ? entry : 0;
  }
  return rest;
}

/// As far as doubles tell.
Matrix short_left_inverse(const Matrix& K, Matrix* rest) {
  Matrix inverse = linalg::pseudo_inverse(K);
  if (rest) *rest = Matrix::Identity(K.rows(), K.rows()) - linalg::product(K, inverse);
  return inverse;
}

}  // namespace

Matrix left_inverse(const Matrix& K, Matrix* rest) {
  constexpr Index most = 100;
  const Index n = K.cols(), m = K.rows();
  if (n == 0 || n > most || !K.allFinite()) return short_left_inverse(K, rest);
  const Vector units = linalg::row_scales(K.transpose());  // powers of two
  const Matrix scaled = K * units.asDiagonal();
  std::optional<Table> L = factor(scaled);
  if (!L) return short_left_inverse(K, rest);
  Matrix inverse(n, m);
  if (rest) *rest = Matrix(m, m);
  std::vector<Long> x(static_cast<std::size_t>(n));
  for (Index r = 0; r < m; ++r) {
    for (Index i = 0; i < n; ++i) x[static_cast<std::size_t>(i)] = scaled(r, i);
    solve(*L, x);
    for (Index i = 0; i < n; ++i)
      inverse(i, r) = units[i] * static_cast<double>(x[static_cast<std::size_t>(i)]);
    if (rest) rest->col(r) = column_of_rest(scaled, x, r);
  }
  return without_rounding(inverse, K);
}

}  // namespace cordon::estimators
