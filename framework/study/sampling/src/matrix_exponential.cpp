// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/sampling/matrix_exponential.hpp"

#include <algorithm>

namespace cordon::sampling {

namespace {

/// A bound of one operation's relative rounding error: numbers have 168 bits.
constexpr double unit_roundoff = 0x1p-166;
/// Covers the roundings of bounds themselves, and underflow.
constexpr double slack = 1 + 1e-6, tiny = 1e-290;

constexpr int terms = 16;           // of the series
constexpr int largest_norm = -8;    // log₂ of what the series is taken of
constexpr int most_doublings = 60;  // beyond it, no plant is sampled in earnest

Matrix sizes(const LongMatrix& X) { return X.cwiseAbs().cast<double>(); }

Matrix bound(const Matrix& error) { return (error.array() * slack + tiny).matrix(); }

Enclosed identity(Index n) { return exactly(LongMatrix::Identity(n, n)); }

}  // namespace

Enclosed exactly(LongMatrix A) {
  const Index rows = A.rows(), cols = A.cols();
  return {std::move(A), Matrix::Zero(rows, cols)};
}

Enclosed scaled(Enclosed X, const Long& factor) {
  X.value *= factor;
  X.error = bound(X.error * std::abs(factor.convert_to<double>()) + unit_roundoff * sizes(X.value));
  return X;
}

Enclosed product(const Enclosed& X, const Enclosed& Y) {
  const double rounding = static_cast<double>(X.value.cols() + 2) * unit_roundoff;
  const Matrix x = sizes(X.value), y = sizes(Y.value);
  return {X.value * Y.value, bound((rounding * x + X.error) * y + (x + X.error) * Y.error)};
}

Enclosed sum(const Enclosed& X, const Enclosed& Y) {
  LongMatrix value = X.value + Y.value;
  Matrix error = bound(X.error + Y.error + unit_roundoff * sizes(value));
  return {std::move(value), std::move(error)};
}

LongMatrix magnitude(const Enclosed& X) { return X.value.cwiseAbs() + bound(X.error).cast<Long>(); }

Exponential exponential(const LongMatrix& A, double h, std::size_t powers) {
  const Index n = A.rows();
  const Long norm = A.cwiseAbs().rowwise().sum().maxCoeff() * h;
  int halvings = std::max(static_cast<int>(powers) - 1, 0);
  while (halvings < most_doublings && ldexp(norm, -halvings) > ldexp(Long(1), largest_norm))
    ++halvings;
  const Long step = ldexp(Long(h), -halvings);
  const Enclosed X = scaled(exactly(A), step);
  // ∫₀ᵗ e^{As} ds = t (I + X/2! + X²/3! + …), and what the series leaves out is below twice its
  // first term, for ‖X‖ is small.
  Enclosed series = identity(n);
  for (int k = terms; k >= 1; --k)
    series = sum(identity(n), scaled(product(X, series), Long(1) / (k + 1)));
  double rest = 2;
  const double size = magnitude(X).rowwise().sum().maxCoeff().convert_to<double>() * slack;
  for (int k = 1; k <= terms + 1; ++k) rest *= size / (k + 1);
  series.error = bound((series.error.array() + rest).matrix());

  Exponential result;
  result.integral = scaled(series, step);
  result.power.assign(std::max<std::size_t>(powers, 1), identity(n));
  Enclosed power = sum(identity(n), product(X, series));
  for (int j = halvings;; --j) {
    if (static_cast<std::size_t>(j) < result.power.size())
      result.power[static_cast<std::size_t>(j)] = power;
    if (j == 0) break;
    result.integral = sum(result.integral, product(power, result.integral));
    power = product(power, power);
  }
  return result;
}

LongMatrix metzler_majorant(const Matrix& A, const Matrix& R) {
  LongMatrix M(A.rows(), A.cols());
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < A.cols(); ++j) {
      const Long radius = R.size() == 0 ? 0 : R(i, j), size = std::abs(A(i, j));
      M(i, j) = (i == j ? Long(A(i, j)) : size) + radius + (size + radius) * (4 * unit_roundoff);
    }
  }
  return M;
}

}  // namespace cordon::sampling
