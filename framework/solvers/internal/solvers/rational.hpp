// SPDX-License-Identifier: GPL-3.0-or-later
// Matrices of rational numbers, and the way from doubles to them and back.
#pragma once

#include <gmpxx.h>
#include <vector>

#include "cordon/core/rounding.hpp"
#include "cordon/core/types.hpp"

namespace cordon::rational {

using Rational = mpq_class;
using RationalVector = std::vector<Rational>;

/// Dense, row by row.
class RationalMatrix {
 public:
  RationalMatrix() = default;
  RationalMatrix(Index rows, Index cols)
      : rows_(rows), cols_(cols), data_(static_cast<std::size_t>(rows * cols)) {}

  Index rows() const { return rows_; }
  Index cols() const { return cols_; }
  Rational& operator()(Index i, Index j) { return data_[static_cast<std::size_t>(i * cols_ + j)]; }
  const Rational& operator()(Index i, Index j) const {
    return data_[static_cast<std::size_t>(i * cols_ + j)];
  }
  RationalVector row(Index i) const;
  void swap_rows(Index i, Index k);

 private:
  Index rows_ = 0, cols_ = 0;
  RationalVector data_;
};

/// The double as the number it is. Errc::not_finite for NaN and infinity: GMP raises a signal for
/// them.
Rational exact(double x);
RationalVector exact(VectorIn x);
RationalMatrix exact_matrix(MatrixIn A);

Rational dot(const RationalVector& x, const RationalVector& y);
/// A B; zeros cost nothing.
RationalMatrix product(const RationalMatrix& A, const RationalMatrix& B);

/// The largest double below or at q and the smallest one above or at q; ±inf beyond the range of
/// doubles.
Interval enclose(const Rational& q);
/// The nearest double; an infinity beyond the range of doubles.
double nearest(const Rational& q);

/// Multiplies by the positive number that makes the entries integers without a common factor; a
/// zero vector stays.
void make_primitive(RationalVector& x);

/// Divides by the power of two that brings the largest entry into [1/2, 2), so that it fits into
/// doubles.
void scale_to_one(RationalVector& x);

/// Gauss-Jordan: brings A to reduced row echelon form and returns the pivots' columns. Pivots are
/// sought among the first `columns` columns.
std::vector<Index> reduce_rows(RationalMatrix& A, Index columns);

/// The rows that do not depend on those before them. Of a matrix with many rows, the ones after the
/// last such row are not looked at if these span everything.
std::vector<Index> independent_rows(const RationalMatrix& A);

/// A basis of {x : A x = 0}, one vector per row.
RationalMatrix null_space(RationalMatrix A);

/// By fraction-free elimination.
Rational determinant(RationalMatrix A);

}  // namespace cordon::rational
