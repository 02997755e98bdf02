// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/exact_modes.hpp"

#include <cmath>
#include <string>

#include "cordon/core/error.hpp"
#include "solvers/rational.hpp"

namespace cordon::exact {

namespace {

using rational::Rational;
using rational::RationalMatrix;
using rational::RationalVector;

constexpr Index most_states = 40;

RationalVector times(const RationalVector& row, const RationalMatrix& A) {
  RationalVector image(static_cast<std::size_t>(A.cols()));
  for (Index i = 0; i < A.rows(); ++i) {
    const Rational& factor = row[static_cast<std::size_t>(i)];
    if (sgn(factor) == 0) continue;
    for (Index j = 0; j < A.cols(); ++j) {
      if (sgn(A(i, j)) != 0) image[static_cast<std::size_t>(j)] += factor * A(i, j);
    }
  }
  return image;
}

/// A basis of the span of C, C A, C A², …: each row is new to those before it, and images of rows
/// that are not lie in the span.
RationalMatrix shown_rows(const RationalMatrix& A, const RationalMatrix& C) {
  const Index n = A.rows();
  std::vector<RationalVector> basis, waiting;
  std::vector<std::size_t> pivots;
  for (Index i = 0; i < C.rows(); ++i) waiting.push_back(C.row(i));
  for (std::size_t next = 0; next < waiting.size() && static_cast<Index>(basis.size()) < n;
       ++next) {
    RationalVector row = waiting[next];
    for (std::size_t k = 0; k < basis.size(); ++k) {
      const Rational factor = row[pivots[k]] / basis[k][pivots[k]];
      if (sgn(factor) == 0) continue;
      for (std::size_t j = 0; j < row.size(); ++j) row[j] -= factor * basis[k][j];
    }
    std::size_t pivot = 0;
    while (pivot < row.size() && sgn(row[pivot]) == 0) ++pivot;
    if (pivot == row.size()) continue;
    rational::make_primitive(row);
    waiting.push_back(times(row, A));
    pivots.push_back(pivot);
    basis.push_back(std::move(row));
  }
  RationalMatrix rows(static_cast<Index>(basis.size()), n);
  for (std::size_t i = 0; i < basis.size(); ++i) {
    for (Index j = 0; j < n; ++j)
      rows(static_cast<Index>(i), j) = basis[i][static_cast<std::size_t>(j)];
  }
  return rows;
}

/// A on the span of the rows of `basis`, which A maps into itself. Row i is the only one with an
/// entry in its own free column, and that is 1: coordinates of an image are its entries there.
RationalMatrix restricted(const RationalMatrix& A, const RationalMatrix& basis) {
  const Index d = basis.rows(), n = A.rows();
  const auto is_own = [&](Index i, Index j) {
    for (Index k = 0; k < d; ++k) {
      if (k == i ? basis(k, j) != 1 : sgn(basis(k, j)) != 0) return false;
    }
    return true;
  };
  RationalMatrix M(d, d);
  for (Index i = 0; i < d; ++i) {
    Index own = 0;
    while (!is_own(i, own)) ++own;
    for (Index k = 0; k < d; ++k) {
      for (Index j = 0; j < n; ++j) {
        if (sgn(A(own, j)) != 0 && sgn(basis(k, j)) != 0) M(i, k) += A(own, j) * basis(k, j);
      }
    }
  }
  return M;
}

Matrix rounded(const RationalMatrix& M) {
  Matrix doubles(M.rows(), M.cols());
  for (Index i = 0; i < M.rows(); ++i) {
    for (Index j = 0; j < M.cols(); ++j) doubles(i, j) = rational::nearest(M(i, j));
  }
  return doubles;
}

/// Coefficients of det(zI - M), that of zʲ at j, by the traces of Faddeev and Le Verrier.
RationalVector characteristic(const RationalMatrix& M) {
  const Index d = M.rows();
  RationalVector coefficients(static_cast<std::size_t>(d) + 1);
  coefficients[static_cast<std::size_t>(d)] = 1;
  RationalMatrix power(d, d);
  for (Index k = 1; k <= d; ++k) {
    for (Index i = 0; i < d; ++i) power(i, i) += coefficients[static_cast<std::size_t>(d - k + 1)];
    power = rational::product(M, power);
    Rational trace = 0;
    for (Index i = 0; i < d; ++i) trace += power(i, i);
    coefficients[static_cast<std::size_t>(d - k)] = -trace / k;
  }
  return coefficients;
}

RationalMatrix closed_loop(MatrixIn A, MatrixIn L, MatrixIn C) {
  if (A.cols() != A.rows() || L.rows() != A.rows() || C.cols() != A.rows() ||
      L.cols() != C.rows()) {
    throw Error(Errc::dimension, "A - L C: the shapes of A, L and C do not fit");
  }
  RationalMatrix closed = rational::exact_matrix(A);
  const RationalMatrix shown =
      rational::product(rational::exact_matrix(L), rational::exact_matrix(C));
  for (Index i = 0; i < closed.rows(); ++i) {
    for (Index j = 0; j < closed.cols(); ++j) closed(i, j) -= shown(i, j);
  }
  return closed;
}

void check_states(Index n) {
  if (n > most_states) {
    throw Error(Errc::unsupported, "exact modes: " + std::to_string(n) + " states; at most " +
                                       std::to_string(most_states) +
                                       " are supported in rational arithmetic");
  }
}

/// Are all roots of Σ p_j zʲ inside the unit circle? |p_0| < |p_d|, and so for (p_d p(z) - p_0 zᵈ
/// p(1/z)) / z.
bool inside_circle(RationalVector p) {
  while (p.size() > 1) {
    rational::make_primitive(p);
    const Rational first = p.front(), last = p.back();
    if (abs(first) >= abs(last)) return false;
    RationalVector next(p.size() - 1);
    for (std::size_t i = 0; i < next.size(); ++i)
      next[i] = last * p[i + 1] - first * p[p.size() - 2 - i];
    p = std::move(next);
  }
  return true;
}

}  // namespace

Index rank(MatrixIn M) {
  RationalMatrix exact = rational::exact_matrix(M);
  return static_cast<Index>(rational::reduce_rows(exact, exact.cols()).size());
}

HiddenModes hidden_modes(MatrixIn A, MatrixIn C, double rate) {
  const Index n = A.rows();
  if (A.cols() != n || C.cols() != n) {
    throw Error(Errc::dimension,
                "exact::hidden_modes: A must be square, with as many columns as C");
  }
  if (!(rate > 0) || !std::isfinite(rate))
    throw Error(Errc::invalid, "exact::hidden_modes: the rate must be a positive number");
  check_states(n);
  const RationalMatrix exact_A = rational::exact_matrix(A);
  const RationalMatrix hidden =
      rational::null_space(shown_rows(exact_A, rational::exact_matrix(C)));
  HiddenModes modes{hidden.rows(), true, Matrix(n, 0), Matrix(0, 0)};
  if (modes.count == 0) return modes;
  RationalMatrix M = restricted(exact_A, hidden);
  modes.basis = rounded(hidden).transpose();
  modes.map = rounded(M);
  if (rate != 1) {
    M = rational::product(M, M);
    const Rational factor = rational::exact(rate);
    for (Index i = 0; i < M.rows(); ++i) {
      for (Index j = 0; j < M.cols(); ++j) M(i, j) /= factor;
    }
  }
  modes.decay = inside_circle(characteristic(M));
  return modes;
}

bool is_schur(MatrixIn A, MatrixIn L, MatrixIn C) {
  check_states(A.rows());
  return inside_circle(characteristic(closed_loop(A, L, C)));
}

bool is_nonnegative(MatrixIn A, MatrixIn L, MatrixIn C) {
  const RationalMatrix closed = closed_loop(A, L, C);
  for (Index i = 0; i < closed.rows(); ++i) {
    for (Index j = 0; j < closed.cols(); ++j) {
      if (sgn(closed(i, j)) < 0) return false;
    }
  }
  return true;
}

}  // namespace cordon::exact
