// SPDX-License-Identifier: GPL-3.0-or-later
// Points that satisfy few equations in many variables: proposals by least squares, and a proof that
// a solution is near.
#pragma once

#include <vector>

#include "cordon/core/types.hpp"

namespace cordon {

/// A factor of A Aᵀ with a proven lower bound of its smallest eigenvalue λ: K - s I has a Cholesky
/// factor in floating point, so λ ≥ s minus what rounding can hide [Rump2006]. Then A δ = r has a
/// solution with ‖δ‖₂ ≤ ‖r‖₂ / √λ.
class RowGram {
 public:
  /// Zero rows are left out, the others scaled by powers of two. `error` bounds |b - true
  /// right-hand side|. O(m² g).
  RowGram(const Matrix& A, const Vector& b, const Vector& error);

  /// Regular beyond doubt, and no row says 0 = b ≠ 0: only then may the others be called.
  bool is_regular() const { return smallest_ > 0; }
  /// The solution of the rows with the smallest ‖ξ‖₂, up to rounding, and multipliers with ξ = Aᵀy.
  struct Point {
    Vector xi, y;
  };
  Point least_squares() const;
  /// Some solution, for every right-hand side within `error`, lies within this distance of ξ in
  /// every coordinate.
  double distance(const Vector& xi) const;

 private:
  void factor();
  void solve(Vector& v) const;  ///< v becomes (A Aᵀ)⁻¹v

  // Of the rows that are not zero, scaled; |A| 1 is rounded up.
  auto right() { return of_rows_.col(0); }
  auto right() const { return of_rows_.col(0); }
  auto unsure() { return of_rows_.col(1); }
  auto unsure() const { return of_rows_.col(1); }
  auto reach() { return of_rows_.col(2); }
  auto reach() const { return of_rows_.col(2); }
  auto scale() { return of_rows_.col(3); }
  auto scale() const { return of_rows_.col(3); }

  std::vector<Index> rows_;  ///< that are not zero
  Matrix A_, L_, of_rows_;
  Index all_;
  double smallest_ = 0;
};

}  // namespace cordon
