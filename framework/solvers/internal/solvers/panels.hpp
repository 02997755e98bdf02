// SPDX-License-Identifier: GPL-3.0-or-later
// Small dense kernels with one order of summation: they vectorise across columns or entries, never
// within a sum, so that results do not depend on the instructions that the compiler may use.
#pragma once

#include <vector>

#include "cordon/core/vectors.hpp"

namespace cordon {

/// As many numbers as a cache line holds, computed with in parts that every processor has registers
/// for.
template <class Scalar>
struct Line {
  using Part [[gnu::vector_size(16), gnu::may_alias]] = Scalar;
  static constexpr Index size = 64 / static_cast<Index>(sizeof(Scalar));
  static constexpr Index step = 16 / static_cast<Index>(sizeof(Scalar));
  Part part[4] = {};

  static Line load(const Scalar* from) {
    Line line;
    for (int k = 0; k < 4; ++k) __builtin_memcpy(&line.part[k], from + k * step, 16);
    return line;
  }
  void store(Scalar* to) const {
    for (int k = 0; k < 4; ++k) __builtin_memcpy(to + k * step, &part[k], 16);
  }
  /// *this += a x.
  void add(Scalar a, const Line& x) {
    for (int k = 0; k < 4; ++k) part[k] += a * x.part[k];
  }
  /// *this += a x, entrywise.
  void add(const Line& a, const Line& x) {
    for (int k = 0; k < 4; ++k) part[k] += a.part[k] * x.part[k];
  }
  Scalar total() const {
    const Part sum = (part[0] + part[1]) + (part[2] + part[3]);
    Scalar value = 0;
    for (Index k = 0; k < step; ++k) value += sum[k];
    return value;
  }
};

/// A matrix in panels of columns, each a line wide: panel after panel, row after row, so that Aᵀy
/// reads memory in order and keeps a sum per column in registers. The last panel is filled with
/// zeros.
template <class Scalar>
class Panels {
 public:
  static constexpr Index width = Line<Scalar>::size;

  Panels(Index rows, Index cols)
      : rows_(rows),
        panels_((cols + width - 1) / width),
        data_(static_cast<std::size_t>(rows_ * panels_ * width)) {}
  explicit Panels(const Matrix& A) : Panels(A.rows(), A.cols()) {
    for (Index j = 0; j < A.cols(); ++j) {
      Scalar* const to = line(j / width, 0) + j % width;
      for (Index i = 0; i < rows_; ++i) to[i * width] = static_cast<Scalar>(A(i, j));
    }
  }

  Index rows() const { return rows_; }
  Index panels() const { return panels_; }
  Index padded_cols() const { return panels_ * width; }
  /// The entries of a row in a panel.
  const Scalar* line(Index p, Index row) const { return data_.data() + (p * rows_ + row) * width; }
  Scalar* line(Index p, Index row) { return data_.data() + (p * rows_ + row) * width; }

  /// out = Aᵀy, for all columns with padding.
  void transpose_times(const Scalar* y, Scalar* out) const {
    for (Index p = 0; p < panels_; ++p) transpose_times(p, y).store(out + p * width);
  }
  /// (columns of one panel)ᵀ y.
  Line<Scalar> transpose_times(Index p, const Scalar* y) const {
    const Scalar* from = line(p, 0);
    Line<Scalar> sum;
    for (Index i = 0; i < rows_; ++i, from += width) sum.add(y[i], Line<Scalar>::load(from));
    return sum;
  }
  /// sums += (columns of one panel) x, place by place: one line of sums per row, whose totals are
  /// the product.
  void add_times(Index p, const Line<Scalar>& x, Scalar* sums) const {
    const Scalar* from = line(p, 0);
    for (Index i = 0; i < rows_; ++i, from += width, sums += width) {
      Line<Scalar> sum = Line<Scalar>::load(sums);
      sum.add(x, Line<Scalar>::load(from));
      sum.store(sums);
    }
  }

 private:
  Index rows_, panels_;
  std::vector<Scalar> data_;
};

}  // namespace cordon
