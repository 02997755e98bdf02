// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over numbers in a row, with one order of summation on every machine: they vectorise across
// entries, in registers of 16 bytes. Where a function says "padded", numbers lie in memory up to
// the next multiple of `block`, and those beyond the end are 0.
#pragma once

#include "cordon/core/types.hpp"

namespace cordon::vectors {

inline constexpr Index block = 4;
/// The smallest multiple of `block` that is at least n.
inline constexpr Index padded(Index n) { return (n + block - 1) / block * block; }

using Pair [[gnu::vector_size(16), gnu::may_alias]] = double;
inline Pair load(const double* from) {
  Pair pair;
  __builtin_memcpy(&pair, from, sizeof pair);
  return pair;
}
inline void store(double* to, Pair pair) { __builtin_memcpy(to, &pair, sizeof pair); }

/// xᵀy, padded.
inline double dot(Index n, const double* x, const double* y) {
  Pair low{0, 0}, high{0, 0};
  for (Index i = 0; i < n; i += block) {
    low += load(x + i) * load(y + i);
    high += load(x + i + 2) * load(y + i + 2);
  }
  low += high;
  return low[0] + low[1];
}

/// max |x_i|, padded; NaN does not count.
inline double largest_size(Index n, const double* x) {
  Pair low{0, 0}, high{0, 0};
  for (Index i = 0; i < n; i += block) {
    const Pair first = load(x + i), second = load(x + i + 2);
    low = first > low ? first : low;
    low = -first > low ? -first : low;
    high = second > high ? second : high;
    high = -second > high ? -second : high;
  }
  low = high > low ? high : low;
  return low[0] < low[1] ? low[1] : low[0];
}

/// max w_i x_i for w, x ≥ 0, padded; NaN does not count.
inline double largest_product(Index n, const double* w, const double* x) {
  Pair low{0, 0}, high{0, 0};
  for (Index i = 0; i < n; i += block) {
    const Pair first = load(w + i) * load(x + i), second = load(w + i + 2) * load(x + i + 2);
    low = first > low ? first : low;
    high = second > high ? second : high;
  }
  low = high > low ? high : low;
  return low[0] < low[1] ? low[1] : low[0];
}

/// y += a x, padded.
inline void add_multiple(Index n, double a, const double* x, double* y) {
  for (Index i = 0; i < n; i += block) {
    const Pair low = load(y + i) + a * load(x + i), high = load(y + i + 2) + a * load(x + i + 2);
    store(y + i, low);
    store(y + i + 2, high);
  }
}

/// Is every entry a finite number? The question is asked of every result: 0·x is 0 for these alone.
inline bool all_finite(Index n, const double* x) {
  Pair low{0, 0}, high{0, 0};
  Index i = 0;
  for (; i + block <= n; i += block) {
    low += load(x + i) * 0.0;
    high += load(x + i + 2) * 0.0;
  }
  double rest = 0;
  for (; i < n; ++i) rest += x[i] * 0.0;
  low += high;
  return low[0] + low[1] + rest == 0;
}
template <class Derived>
bool all_finite(const Eigen::DenseBase<Derived>& A) {
  const Derived& matrix = A.derived();
  const Index rows = matrix.rows(), cols = matrix.cols();
  if (cols == 1 || matrix.outerStride() == rows) return all_finite(rows * cols, matrix.data());
  for (Index j = 0; j < cols; ++j) {
    if (!all_finite(rows, matrix.data() + j * matrix.outerStride())) return false;
  }
  return true;
}

/// Most maps of observers have so few rows and columns that preparing for large ones would cost
/// more than the product itself.
inline bool is_small(MatrixIn A) { return A.rows() <= 6 && A.cols() <= 12; }

/// C = A B for a small A.
template <int rows>
void small_product(MatrixIn A, MatrixIn B, Eigen::Ref<Matrix> C) {
  for (Index j = 0; j < B.cols(); ++j) {
    const double* const from = B.data() + j * B.outerStride();
    double sums[rows] = {};
    for (Index k = 0; k < A.cols(); ++k) {
      const double* const column = A.data() + k * A.outerStride();
      for (int i = 0; i < rows; ++i) sums[i] += column[i] * from[k];
    }
    double* const to = C.data() + j * C.outerStride();
    for (int i = 0; i < rows; ++i) to[i] = sums[i];
  }
}
/// K = A Aᵀ for an A of few rows.
template <int rows>
void small_gram(MatrixIn A, Matrix& K) {
  double sums[rows * rows] = {};
  for (Index k = 0; k < A.cols(); ++k) {
    const double* const column = A.data() + k * A.outerStride();
    for (int j = 0; j < rows; ++j) {
      for (int i = j; i < rows; ++i) sums[j * rows + i] += column[i] * column[j];
    }
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = j; i < rows; ++i) K(i, j) = K(j, i) = sums[j * rows + i];
  }
}
inline void small_gram(MatrixIn A, Matrix& K) {
  using Gram = void (*)(MatrixIn, Matrix&);
  constexpr Gram of_rows[] = {small_gram<1>, small_gram<2>, small_gram<3>,
                              small_gram<4>, small_gram<5>, small_gram<6>};
  K.resize(A.rows(), A.rows());
  if (A.rows() > 0) of_rows[A.rows() - 1](A, K);
}

inline void small_product(MatrixIn A, MatrixIn B, Eigen::Ref<Matrix> C) {
  using Product = void (*)(MatrixIn, MatrixIn, Eigen::Ref<Matrix>);
  constexpr Product of_rows[] = {small_product<1>, small_product<2>, small_product<3>,
                                 small_product<4>, small_product<5>, small_product<6>};
  if (A.rows() > 0) of_rows[A.rows() - 1](A, B, C);
}

}  // namespace cordon::vectors
