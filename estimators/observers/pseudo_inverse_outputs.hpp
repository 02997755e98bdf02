// SPDX-License-Identifier: GPL-3.0-or-later
// What the outputs of a sample have to do with its state, for pseudo_inverse_observer.hpp.
#pragma once

#include <vector>

#include "cordon/interfaces/model.hpp"
#include "observers/rounding_room.hpp"

namespace cordon::estimators {

/// With T E + N C + R = I for the outputs that are used, those of a sample which are there and
/// which the measurement itself bounds:
///   x⁺ = T (A x + B u + Bw w) + N (y⁺ - D u⁺ - Dv v⁺) + R x⁺
/// [T N] is the pseudo-inverse of [E; C], and R = 0 where E x and these outputs determine the
/// state. Else R x⁺ is what they leave open.
struct PseudoInverseOutputs {
  PseudoInverseOutputs(const Model& full, const std::vector<Index>& present, bool rounds_outward);

  LinearModel used;  ///< weighted by the middle of the sensors' effectiveness; rows of zeros for
                     ///< other outputs
  Vector is_used;    ///< per output: 1 or 0
  bool determines_state;
  // of the sample of this time
  Matrix T, N, TA, TA_transposed, TB, TBw, minus_ND, minus_NDv;
  Matrix open;           ///< R; 0×0: 0
  Matrix open_error;     ///< a bound of the rounding of R
  Matrix inverse_error;  ///< a bound of |T E + N C + R - I|; 0×0: negligible, and the backend does
                         ///< not round outward
  Matrix TA_terms;       ///< |T| |A|
  double TB_norm = 0, TA_norm = 0;
  Vector disturbance;   ///< center of T Bw W ⊕ (-N Dv V)
  Thickness thickness;  ///< of the same
  // of the sample before
  Matrix noise_generators;  ///< Dv Gv
  Matrix C_transposed;
  double C_norm, D_norm;
};

/// All outputs of the model, in order.
std::vector<Index> all_outputs(const LinearModel& model);

/// Do E x and these outputs determine the state?
bool determine_state(const LinearModel& model, const std::vector<Index>& outputs);

/// Relative error of sums of as many terms as a step of the observer has.
double accumulated_rounding(const LinearModel& model);

}  // namespace cordon::estimators
