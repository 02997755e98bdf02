// SPDX-License-Identifier: GPL-3.0-or-later
// The prediction of sets by x⁺ = A x + B u + Bw w, which observers share that correct a prediction.
#pragma once

#include "observers/effectiveness.hpp"
#include "observers/rounding_room.hpp"

namespace cordon::estimators {

/// A X ⊕ {B u} ⊕ Bw W, with what ranges of actuators and interval matrices A and B leave open
/// (effectiveness.hpp), and room for the rounding of B u where it cancels beside Bw W. Claimed
/// outer where a matrix is an interval; W as the backend holds it.
class Prediction {
 public:
  /// Model, backend and effectiveness outlive the object.
  Prediction(const Model& model, const SetBackend& backend, const Effectiveness& effectiveness);

  Enclosure next(const Enclosure& X, VectorIn u) const;

 private:
  RoundingRoom room_of(const Vector& shift, VectorIn u) const;

  const Model& model_;
  const SetBackend& backend_;
  const Effectiveness& effectiveness_;
  Enclosure W_;
  Vector disturbance_;   ///< center of Bw W
  Thickness thickness_;  ///< of Bw W
};

/// The model of a state that stays where it is, x⁺ = x, with the outputs, inputs and noise of
/// `model`: a Luenberger recursion of it is a correction by a gain.
Model at_rest(const Model& model);

}  // namespace cordon::estimators
