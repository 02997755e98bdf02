// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated data beside the equations that they were made from, in exact arithmetic: a simulation
// rounds.
#pragma once

#include "cordon/interfaces/model.hpp"
#include "cordon/study/data.hpp"

namespace cordon::detail {

/// Is it proven, with the doubles as the numbers they are, that no w ∈ W has E x_{k+1} = A x_k + B
/// diag(f) u_k + Bw w? f and g are the centers of the ranges of actuators and sensors; where A, B
/// or C are interval matrices, or f or g have a width, nothing is proven. Both records have a
/// truth.
bool contradicts_dynamics(const Model& model, const Record& before, const Record& now);

/// The same for y_k = diag(g) (C x_k + D diag(f) u_k) + Dv v and v ∈ V.
bool contradicts_outputs(const Model& model, const Record& now);

}  // namespace cordon::detail
