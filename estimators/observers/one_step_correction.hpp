// SPDX-License-Identifier: GPL-3.0-or-later
// Prediction and correction by one gain as one map, for x⁺ = A x + B f u + Bw w and y = g (C x + D
// f u) + Dv v of exact matrices, actuators and sensors.
#pragma once

#include <memory>
#include <optional>

#include "cordon/interfaces/backend.hpp"
#include "cordon/interfaces/model.hpp"
#include "observers/rounding_room.hpp"

namespace cordon::estimators {

/// With C̄ = g C, D̄ = g D f and N = I - Λ C̄:
///   X̂⁺ = N A X̂ ⊕ {N B f u + Λ (y⁺ - D̄ u⁺)} ⊕ N Bw W ⊕ (-Λ Dv) V,
/// the correction of A X̂ ⊕ {B f u} ⊕ Bw W without the set in between. The products are made once;
/// what they, and the sums of each step, have been rounded by has room in X̂⁺, as a share of the
/// magnitudes of all their terms before these cancel (rounding_room.hpp).
class OneStepCorrection {
 public:
  /// Is no matrix, actuator or sensor known as a range?
  static bool takes(const Model& model);
  /// For a model that it takes. `gain`: Λ, n×n_y. The backend outlives the object. Throws where W
  /// or V has no bounds.
  OneStepCorrection(const Model& model, const Matrix& gain, const SetBackend& backend);

  /// X̂⁺ before reduction, from X̂, the input of its time and the complete sample of the next one; ∅
  /// where an output is proven to contradict the prediction. Nothing where X̂ is empty or has no
  /// bounds.
  std::optional<Enclosure> next(const Enclosure& X, VectorIn u, const Sample& now) const;

 private:
  /// X x + U u + V u⁺ + Y y⁺ + constant.
  struct Rows {
    Matrix X, U, V, Y;
    Vector constant;

    /// The part that is known: U u + V u⁺ + Y y⁺.
    Vector known(VectorIn u, const Sample& now) const;
    /// Of rows of magnitudes, for states of these sizes.
    Vector sizes(const Vector& states, VectorIn u, const Sample& now) const;
  };

  bool is_contradicted(const Enclosure& X, const Box& reach, const Vector& largest, VectorIn u,
                       const Sample& now) const;
  std::optional<RoundingRoom> room_of(const Box& reach, const Vector& largest, const Vector& shift,
                                      VectorIn u, const Sample& now) const;

  const SetBackend& backend_;
  Enclosure W_, V_;
  Rows state_, state_terms_;    ///< of x⁺, and of the magnitudes it is made of
  Rows output_, output_terms_;  ///< of y⁺ less what is predicted
  Matrix state_W_, state_V_, output_W_, output_V_;  ///< maps of W and V in both
  Vector noise_;                                    ///< half widths of what they make of y⁺
  Thickness thickness_;
};

}  // namespace cordon::estimators
