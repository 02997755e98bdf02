// SPDX-License-Identifier: GPL-3.0-or-later
// Prediction and correction for x⁺ = A x + B u + Bw w, y = C x + D u + Dv v on any backend:
//   X̂_0 = {x ∈ X0 : y_0 - D u_0 - C x ∈ Dv V}
//   X̄_k = A X̂_{k-1} ⊕ {B u_{k-1}} ⊕ Bw W,   X̂_k = {x ∈ X̄_k : y_k - D u_k - C x ∈ Dv V},
// of the state alone, or of a stack z_k = (x_k, x_{k-1}, …) of the states of several times:
//   z⁺ = [A 0; I 0] z + [B; 0] u + [Bw; 0] w,   y = [C 0 … 0] z + D u + Dv v.
// Ranges of effectiveness and interval matrices: effectiveness.hpp.
#pragma once

#include "observers/effectiveness.hpp"
#include "observers/rounding_room.hpp"

namespace cordon::estimators {

/// The matrices of the step from a stack of `from` times to one of `to`, and of the outputs of the
/// latter. The newest time comes first.
struct StackStep {
  /// 1 ≤ to ≤ from + 1; with 1 and 1 those of the model.
  StackStep(const LinearModel& model, Index from, Index to);

  Index from, to;
  Matrix A;       ///< n to × n from
  Matrix B, Bw;   ///< n to rows, those below the first n are 0
  Matrix C;       ///< n to columns, those beside the first n are 0
  Matrix newest;  ///< [I; 0], n to × n: what enters the newest state only
};

class CorrectedRecursion {
 public:
  /// Model and backend outlive the object. W and V are imported: the backend's errors pass through.
  CorrectedRecursion(const Model& model, const SetBackend& backend);

  Enclosure predicted(const Enclosure& X, const StackStep& step, VectorIn u) const;
  Enclosure corrected(const Enclosure& X, const StackStep& step, const Sample& now) const {
    return effectiveness_.correct(X, step.C, now);
  }

  /// As Observer::claim.
  Tightness claim() const { return claim_; }

 private:
  /// For B u beside the center of Bw W.
  RoundingRoom room_of(const Vector& Bu, VectorIn u) const;

  const Model& model_;
  const SetBackend& backend_;
  Enclosure W_;
  Vector disturbance_;   ///< center of Bw W
  Thickness thickness_;  ///< of Bw W
  Effectiveness effectiveness_;
  Tightness claim_;
};

}  // namespace cordon::estimators
