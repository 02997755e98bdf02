// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/types.hpp"

namespace cordon {

/// Interval matrix [A] = {A : |A - center| ≤ radius}, entrywise; radius ≥ 0 of the same size.
struct IntervalMatrix {
  Matrix center, radius;

  IntervalMatrix() = default;
  IntervalMatrix(Matrix A)
      : center(std::move(A)), radius(Matrix::Zero(center.rows(), center.cols())) {}
  IntervalMatrix(Matrix mid, Matrix rad) : center(std::move(mid)), radius(std::move(rad)) {}

  Index rows() const { return center.rows(); }
  Index cols() const { return center.cols(); }
  bool is_exact() const { return radius.size() == 0 || radius.maxCoeff() == 0.0; }
};

}  // namespace cordon
