// SPDX-License-Identifier: GPL-3.0-or-later
// What multipliers prove about {ξ : Aξ = b, ‖ξ‖∞ ≤ 1}, with rounding errors bounded a priori
// [Higham2002, ch. 3].
#pragma once

#include "cordon/core/types.hpp"
#include "solvers/panels.hpp"

namespace cordon {

/// Many checks of the same rows: |A|1 is known once, so that the bound of the errors costs O(m) and
/// a check one product with Aᵀ.
class RowCertificates {
 public:
  /// `error` bounds |b - true right-hand side|; it may be empty, for none.
  RowCertificates(const Matrix& A, VectorIn b, VectorIn error);

  /// ≥ bᵀy + ‖g - Aᵀy‖₁, hence ≥ max{gᵀξ}, for every right-hand side within `error`.
  double upper_bound(VectorIn g, VectorIn y) const;
  /// ≤ bᵀy - ‖Aᵀy‖₁ for every right-hand side within `error`: positive means empty.
  double farkas_margin(VectorIn y) const;
  /// ≥ |A|1.
  const Vector& reach() const { return reach_; }

 private:
  double residual(const double* g, VectorIn y) const;
  double doubt(VectorIn y) const;

  Index cols_;
  Panels<double> panels_;
  Vector b_, error_, reach_;
  bool exact_;
};

}  // namespace cordon
