// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/rational.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <utility>

#include "cordon/core/error.hpp"

namespace cordon::rational {

namespace {

// Where memory runs out, GMP itself ends the process.
void* allocate(std::size_t size) {
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}

void* reallocate(void* old, std::size_t, std::size_t size) {
  if (void* memory = std::realloc(old, size)) return memory;
  throw std::bad_alloc();
}

[[maybe_unused]] const bool gmp_throws =
    (mp_set_memory_functions(allocate, reallocate, nullptr), true);

}  // namespace

RationalVector RationalMatrix::row(Index i) const {
  const auto begin = data_.begin() + i * cols_;
  return {begin, begin + cols_};
}

void RationalMatrix::swap_rows(Index i, Index k) {
  if (i == k) return;
  for (Index j = 0; j < cols_; ++j) std::swap((*this)(i, j), (*this)(k, j));
}

Rational exact(double x) {
  if (!std::isfinite(x))
    throw Error(Errc::not_finite, "exact arithmetic needs numbers: a NaN or infinite entry");
  return Rational(x);
}

RationalVector exact(VectorIn x) {
  RationalVector out;
  out.reserve(static_cast<std::size_t>(x.size()));
  for (Index i = 0; i < x.size(); ++i) out.push_back(exact(x[i]));
  return out;
}

RationalMatrix exact_matrix(MatrixIn A) {
  RationalMatrix out(A.rows(), A.cols());
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < A.cols(); ++j) out(i, j) = exact(A(i, j));
  }
  return out;
}

Rational dot(const RationalVector& x, const RationalVector& y) {
  Rational sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (sgn(x[i]) != 0 && sgn(y[i]) != 0) sum += x[i] * y[i];
  }
  return sum;
}

RationalMatrix product(const RationalMatrix& A, const RationalMatrix& B) {
  RationalMatrix C(A.rows(), B.cols());
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index k = 0; k < A.cols(); ++k) {
      if (sgn(A(i, k)) == 0) continue;
      for (Index j = 0; j < B.cols(); ++j) {
        if (sgn(B(k, j)) != 0) C(i, j) += A(i, k) * B(k, j);
      }
    }
  }
  return C;
}

Interval enclose(const Rational& q) {
  constexpr double largest = std::numeric_limits<double>::max();
  if (q > Rational(largest)) return {largest, infinity};
  if (q < Rational(-largest)) return {-infinity, -largest};
  // mpq_get_d truncates; what it does near the smallest doubles is left to the comparisons
  double below = q.get_d();
  while (Rational(below) > q) below = rounding::down(below);
  while (below < largest && Rational(rounding::up(below)) <= q) below = rounding::up(below);
  return {below, Rational(below) == q ? below : rounding::up(below)};
}

double nearest(const Rational& q) {
  const Interval range = enclose(q);
  if (range.lower == range.upper) return range.lower;
  if (std::isinf(range.lower) || std::isinf(range.upper))
    return std::isinf(range.lower) ? range.lower : range.upper;
  return q - Rational(range.lower) <= Rational(range.upper) - q ? range.lower : range.upper;
}

void make_primitive(RationalVector& x) {
  mpz_class denominator = 1, divisor = 0;
  for (const Rational& value : x)
    mpz_lcm(denominator.get_mpz_t(), denominator.get_mpz_t(), value.get_den_mpz_t());
  for (Rational& value : x) {
    value *= denominator;
    mpz_gcd(divisor.get_mpz_t(), divisor.get_mpz_t(), value.get_num_mpz_t());
  }
  if (divisor <= 1) return;
  for (Rational& value : x) value /= divisor;
}

void scale_to_one(RationalVector& x) {
  Rational largest = 0;
  for (const Rational& value : x) {
    if (abs(value) > largest) largest = abs(value);
  }
  if (sgn(largest) == 0) return;
  const auto bits = [](const mpz_class& z) {
    return static_cast<long>(mpz_sizeinbase(z.get_mpz_t(), 2));
  };
  const long shift =
      bits(largest.get_num()) - bits(largest.get_den());  // largest / 2^shift lies in (1/2, 2)
  for (Rational& value : x) {
    if (shift > 0)
      mpq_div_2exp(value.get_mpq_t(), value.get_mpq_t(), static_cast<mp_bitcnt_t>(shift));
    if (shift < 0)
      mpq_mul_2exp(value.get_mpq_t(), value.get_mpq_t(), static_cast<mp_bitcnt_t>(-shift));
  }
}

std::vector<Index> reduce_rows(RationalMatrix& A, Index columns) {
  std::vector<Index> pivots;
  Index row = 0;
  for (Index j = 0; j < columns && row < A.rows(); ++j) {
    Index pivot = row;
    while (pivot < A.rows() && sgn(A(pivot, j)) == 0) ++pivot;
    if (pivot == A.rows()) continue;
    A.swap_rows(row, pivot);
    const Rational inverse = 1 / A(row, j);
    for (Index k = j; k < A.cols(); ++k) A(row, k) *= inverse;
    for (Index i = 0; i < A.rows(); ++i) {
      if (i == row || sgn(A(i, j)) == 0) continue;
      const Rational factor = A(i, j);
      for (Index k = j; k < A.cols(); ++k) {
        if (sgn(A(row, k)) != 0) A(i, k) -= factor * A(row, k);
      }
    }
    pivots.push_back(j);
    ++row;
  }
  return pivots;
}

std::vector<Index> independent_rows(const RationalMatrix& A) {
  std::vector<Index> chosen;
  std::vector<std::pair<std::size_t, RationalVector>> echelon;  // with the place of the leading 1
  for (Index i = 0; i < A.rows() && static_cast<Index>(chosen.size()) < A.cols(); ++i) {
    RationalVector x = A.row(i);
    for (const auto& [pivot, row] : echelon) {
      if (sgn(x[pivot]) == 0) continue;
      const Rational factor = x[pivot];
      for (std::size_t k = 0; k < x.size(); ++k) {
        if (sgn(row[k]) != 0) x[k] -= factor * row[k];
      }
    }
    const auto first =
        std::find_if(x.begin(), x.end(), [](const Rational& value) { return sgn(value) != 0; });
    if (first == x.end()) continue;
    const Rational inverse = 1 / *first;
    const auto pivot = static_cast<std::size_t>(first - x.begin());
    for (Rational& value : x) value *= inverse;
    echelon.emplace_back(pivot, std::move(x));
    chosen.push_back(i);
  }
  return chosen;
}

RationalMatrix null_space(RationalMatrix A) {
  const std::vector<Index> pivots = reduce_rows(A, A.cols());
  const Index rank = static_cast<Index>(pivots.size());
  RationalMatrix basis(A.cols() - rank, A.cols());
  Index next = 0;
  for (Index j = 0, row = 0; j < A.cols(); ++j) {
    if (row < rank && pivots[static_cast<std::size_t>(row)] == j) {
      ++row;
      continue;
    }
    basis(next, j) = 1;
    for (Index i = 0; i < rank; ++i) basis(next, pivots[static_cast<std::size_t>(i)]) = -A(i, j);
    ++next;
  }
  return basis;
}

Rational determinant(RationalMatrix A) {
  const Index n = A.rows();
  // rows are scaled to integers, so that the elimination needs no greatest common divisors
  std::vector<mpz_class> T(static_cast<std::size_t>(n * n));
  const auto at = [&](Index i, Index j) -> mpz_class& {
    return T[static_cast<std::size_t>(i * n + j)];
  };
  mpz_class denominator = 1, previous = 1;
  for (Index i = 0; i < n; ++i) {
    mpz_class common = 1;
    for (Index j = 0; j < n; ++j)
      mpz_lcm(common.get_mpz_t(), common.get_mpz_t(), A(i, j).get_den_mpz_t());
    for (Index j = 0; j < n; ++j) at(i, j) = A(i, j).get_num() * (common / A(i, j).get_den());
    denominator *= common;
  }
  int sign = 1;
  for (Index k = 0; k + 1 < n; ++k) {
    Index pivot = k;
    while (pivot < n && at(pivot, k) == 0) ++pivot;
    if (pivot == n) return 0;
    if (pivot != k) {
      for (Index j = 0; j < n; ++j) std::swap(at(k, j), at(pivot, j));
      sign = -sign;
    }
    for (Index i = k + 1; i < n; ++i) {
      for (Index j = k + 1; j < n; ++j) {
        at(i, j) = at(i, j) * at(k, k) - at(i, k) * at(k, j);
        mpz_divexact(at(i, j).get_mpz_t(), at(i, j).get_mpz_t(), previous.get_mpz_t());
      }
    }
    previous = at(k, k);
  }
  if (n == 0) return 1;
  Rational value(sign * at(n - 1, n - 1), denominator);
  value.canonicalize();
  return value;
}

}  // namespace cordon::rational
