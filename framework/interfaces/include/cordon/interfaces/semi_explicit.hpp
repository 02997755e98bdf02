// SPDX-License-Identifier: GPL-3.0-or-later
// The semi-explicit form of a descriptor system E x⁺ = f: equations that give the next dynamic
// states, and equations without x⁺.
#pragma once

#include <memory>

#include "cordon/core/types.hpp"

namespace cordon {

/// E (n×n, finite) of rank r, decided as in descriptor_matrix.hpp. P are the columns and R the rows
/// of its pivots, Q and S the others, each in its order. With Φ = E_RP⁻¹ E_RQ, coordinates z = (z̃,
/// ž) and equations are
///   x_P = z̃ - Φ ž,  x_Q = ž;           z = T⁻¹ x
///   z̃⁺ = E_RP⁻¹ f_R,   0 = f_S - E_SP E_RP⁻¹ f_R
/// Every state and every equation keeps its unit, so that a system in other units has the same
/// digits, which coordinates that mix states (singular vectors) cannot promise.
///
/// E_RP⁻¹ and all products below are computed in rational numbers and rounded to the nearest double
/// once, entry by entry. Φ is rounded too, and T and T⁻¹ are inverse to each other with the Φ that
/// they hold. O(n³) products of rationals.
class SemiExplicitForm {
 public:
  /// The identity, where x_{k+1} is given as it stands.
  explicit SemiExplicitForm(Index n);
  /// Errc::dimension if E is not square; Errc::not_finite, here and below, for NaN and infinity and
  /// where a result overflows.
  explicit SemiExplicitForm(MatrixIn E);

  Index states() const { return T_.rows(); }
  Index rank() const { return rank_; }
  Index static_rows() const { return states() - rank_; }

  const Matrix& T() const { return T_; }                  ///< x = T z
  const Matrix& T_inverse() const { return T_inverse_; }  ///< z = T⁻¹ x

  /// Is Φ the number itself, not rounded?
  bool is_exact() const { return is_exact_; }

  /// Rows that were rounded, or not: `is_exact` if every entry is the number itself.
  struct Part {
    Matrix rows;
    bool is_exact = true;
  };
  /// The dynamic and the static rows of f = M v: what takes the place of M (n×m).
  Part dynamic_part(MatrixIn M) const;
  Part static_part(MatrixIn M) const;
  /// The same of f = A x = A T z.
  Part dynamic_part_of_state(MatrixIn A) const;
  Part static_part_of_state(MatrixIn A) const;
  /// C T: the outputs of z.
  Part outputs_of_state(MatrixIn C) const;

 private:
  struct Rows;  // in rationals; none: the identity
  std::shared_ptr<const Rows> rows_;
  Index rank_ = 0;
  bool is_exact_ = true;
  Matrix T_, T_inverse_;
};

}  // namespace cordon
