// SPDX-License-Identifier: GPL-3.0-or-later
// The error of the observer of one mode while the plant is in another, as a linear system driven by
// bounded disturbances.
#pragma once

#include <string>
#include <vector>

#include "cordon/interfaces/model.hpp"
#include "cordon/sets/zonotope.hpp"

namespace cordon::estimators {

/// The matrices and sets of one mode with its observer, ranges split into centre and radius: C̄ =
/// mid(g) C, D̄ = mid(g) D.
struct ModeDynamics {
  std::string name;
  Matrix A, B, C, D, Bw, Dv, L;
  Matrix Ao;           ///< A - L C̄
  Matrix Bo;           ///< B - L D̄
  Vector f, f_rad;     ///< effectiveness of the actuators
  Vector g_rad;        ///< radius of that of the sensors, 0 where known
  Matrix C_raw;        ///< C
  Vector feedthrough;  ///< bound of |D f u|
  sets::Zonotope W, V;
  Vector u, u_rad;  ///< u ± u_rad contains U
};

/// Throws Errc::dimension for a gain of another shape, Errc::unsupported for a descriptor system,
/// an unbounded U, W or V (with the mode's name), Errc::invalid if A - L C is not Schur.
std::vector<ModeDynamics> dynamics_of(const ModeBank& bank, const std::vector<Matrix>& gains);

/// Half widths of the boxes that hold what ranges of sensors leave open: δ_i of the plant, δ_j of
/// the observer. Empty: 0.
struct SensorSlack {
  Vector plant, observer;
};

/// e⁺ = Ao e + d and r = C̄ e + s, or with the state in front, z = (x, e): z⁺ = A z + d, r = C z +
/// s; d ∈ `drive`, s ∈ `direct`.
struct PairDynamics {
  Matrix A;
  sets::Zonotope drive;
  Matrix C;
  sets::Zonotope direct;
};

/// Does the state of the plant in mode i act on the error of observer j?
bool is_coupled(const ModeDynamics& plant, const ModeDynamics& observer);

/// The pair's system: of e alone if it is not coupled, else of (x, e). `separate` treats the inputs
/// of both as independent.
PairDynamics pair_dynamics(const ModeDynamics& plant, const ModeDynamics& observer, bool separate,
                           const SensorSlack& slack);

/// What enters the residual beside C̄ e, without the share of x.
sets::Zonotope direct_part(const ModeDynamics& plant, const ModeDynamics& observer, bool separate,
                           const SensorSlack& slack);

/// The disturbance of e alone without the share of x.
sets::Zonotope error_drive(const ModeDynamics& plant, const ModeDynamics& observer, bool separate,
                           const SensorSlack& slack);

/// A_i - A_j - L_j (C̄_i - C̄_j), by which x acts on e.
Matrix state_to_error(const ModeDynamics& plant, const ModeDynamics& observer);

/// The disturbance of the plant alone: x⁺ = A x + d.
sets::Zonotope plant_drive(const ModeDynamics& plant);

}  // namespace cordon::estimators
