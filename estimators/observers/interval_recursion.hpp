// SPDX-License-Identifier: GPL-3.0-or-later
// The recursion of interval observers, for one model and one gain. [Pourasghar2021, (39)-(40),
// (56)]
#pragma once

#include <utility>

#include "cordon/core/box.hpp"
#include "cordon/interfaces/model.hpp"

namespace cordon::estimators {

/// For x⁺ = [A] x + [B] f u + Bw w, y = g ([C] x + D f u) + Dv v as in luenberger_recursion.hpp: if
/// |x - c| ≤ r, then |x⁺ - c⁺| ≤ r⁺ with
///   c⁺ = Ao c + (B - L D̄) f̄ u + L y + Bw w̄ - L Dv v̄,   Ao = A - L C̄
///   r⁺ = |Ao| r + Π (|c| + r) + |B - L D̄| rad(f) |u| + rad(B) |max f u| + |L| δ + |Bw G_W| 1 + |L
///   Dv G_V| 1
/// Π = rad(A) + |L| max g rad(C), δ = rad(g) (|C c + D f̄ u| + |C| r + |D| rad(f) |u|), w̄, v̄, G_W
/// and G_V centres and generators of zonotopes around W and V. In bounds lo = c - r, hi = c + r and
/// with Ao = Ao⁺ - Ao⁻ this is
///   hi⁺ = Ao⁺ hi - Ao⁻ lo + … + ξ,   lo⁺ = Ao⁺ lo - Ao⁻ hi + … - ξ,   ξ the terms of r⁺ behind the
///   first.
/// (The printed recursion subtracts L Dv V's share from both bounds, and leaves out the splitting;
/// it loses the truth.) r⁺ includes the rounding errors of c⁺, of its own and of c⁺ ± r⁺, also
/// those of products such as L C̄ that are made in advance: the statement holds for the doubles as
/// stored, in real arithmetic. O(n² + n (n_y + n_u)) per step, without allocations.
class IntervalRecursion {
 public:
  /// L is n×n_y; W and V are bounded. Throws Errc::dimension, and the errors of
  /// invariant::enclosing_zonotope.
  IntervalRecursion(const Model& model, const Matrix& L);

  /// c⁺ and r⁺ into `c_next` and `r_next`, which do not overlap with c and r. Throws
  /// Errc::not_finite where they overflow.
  void next(const Vector& c, const Vector& r, const Sample& now, Vector& c_next, Vector& r_next);
  /// Sizes of the numbers that the last c⁺ and r⁺ were made of, before they cancelled.
  const Vector& size() const { return size_; }

  const Matrix& closed_loop() const { return Ao_; }

 private:
  Matrix Ao_, input_, L_;
  Vector drift_;
  Matrix spread_;           ///< |Ao| + |L| rad(g) |C|, the factor of r
  Matrix parameters_;       ///< Π; 0×0: 0
  Matrix inputs_;           ///< the factor of |u|
  Vector noise_;            ///< |Bw G_W| 1 + |L Dv G_V| 1
  Matrix sensors_, C_, D_;  ///< |L| rad(g), C and D f̄; 0×0: exact sensors
  Matrix state_size_, input_size_, L_abs_;
  Vector noise_size_;
  double rounding_ = 0;
  Vector x_size_, u_size_, y_size_, size_, outputs_;  ///< of one step
};

/// Centre and radii of a box that contains the given one, which is bounded.
std::pair<Vector, Vector> around(const Box& box);

}  // namespace cordon::estimators
