// SPDX-License-Identifier: GPL-3.0-or-later
// What multipliers prove about {ξ : Aξ = b, ‖ξ‖∞ ≤ 1}, with rounding errors bounded a priori [Higham2002, ch. 3].
#pragma once

#include "cordon/core/types.hpp"
#include "solvers/panels.hpp"

namespace cordon {

/// Many checks of the same rows: |A|1 is known once, so that the bound of the errors costs O(m) and a check one product with Aᵀ.
class RowCertificates {
 public:
  /// `error` bounds |b - true right-hand side|.
  RowCertificates(const Matrix& A, const Vector& b, const Vector& error);

  /// ≥ bᵀy + ‖g - Aᵀy‖₁, hence ≥ max{gᵀξ}, for every right-hand side within `error`.
  double upper_bound(VectorIn g, const Vector& y) const;
  /// ≤ bᵀy - ‖Aᵀy‖₁ for every right-hand side within `error`: positive means empty.
  double farkas_margin(const Vector& y) const;
  /// ≥ |A|1.
  const Vector& reach() const { return reach_; }

 private:
  double residual(const double* g, const Vector& y) const;

  Index cols_;
  Panels<double> panels_;
  const Vector& b_;
  const Vector& error_;
  Vector reach_;
  bool exact_;
};

}  // namespace cordon
