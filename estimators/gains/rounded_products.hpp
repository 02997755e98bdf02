// SPDX-License-Identifier: GPL-3.0-or-later
// Products and differences of matrices with bounds of what rounding has made of them.
#pragma once

#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "gains/gain_form.hpp"

namespace cordon::estimators {

inline Rounded exactly(const Matrix& B) { return {B, Matrix::Zero(B.rows(), B.cols())}; }

/// A B for every B within its error.
inline Rounded times(const Matrix& A, const Rounded& B) {
  Matrix error = rounding::product_error(A, B.value) + linalg::product(A.cwiseAbs(), B.error);
  return {linalg::product(A, B.value), error * (1 + 2 * rounding::gamma(A.cols() + 2))};
}

/// A - B; where B is 0 nothing is rounded.
inline Rounded less(const Rounded& A, const Rounded& B) {
  const Matrix sizes = A.value.cwiseAbs() + B.value.cwiseAbs();
  const Matrix own = (B.value.array() != 0).select(2 * rounding::unit * sizes, 0.0);
  return {A.value - B.value, (A.error + B.error + own) * (1 + 4 * rounding::unit)};
}

}  // namespace cordon::estimators
