// SPDX-License-Identifier: GPL-3.0-or-later
// Observer for descriptor systems on any backend [Wang2018a]: with [T N] = [E; C]⁺ it holds T E + N
// C = I, so
//   x_k = (T A - L C) x_{k-1} + T B u_{k-1} + T Bw w_{k-1} + L (y_{k-1} - D u_{k-1} - Dv v_{k-1}) +
//   N (y_k - D u_k - Dv v_k)
// for every gain L; L_k = T A P Cᵀ (C P Cᵀ + Q)⁻¹ with P = G Gᵀ of the estimate and Q = Dv Gv Gvᵀ
// Dvᵀ minimises the F-radius. Outputs whose sensors can fail altogether are left out: y_k enters
// before anything is known of x_k. For the same reason C is exact. Ranges of effectiveness and
// interval matrices A and B: effectiveness.hpp. With a backend that rounds outward the rounding
// errors of all these products are added as a box. Claims no exact estimate: the first measurement
// enters with the second, by a gain, and v_{k-1} twice.
#pragma once

#include <memory>

#include "cordon/registry/plugin.hpp"

namespace cordon::estimators {

std::unique_ptr<Observer> pseudo_inverse_observer(const ObserverContext& context,
                                                  const Params& params);

/// Are there T, N with T E + N C = I? They ask for [E; C] of full column rank, without the outputs
/// that are left out.
bool has_pseudo_inverse(const LinearModel& model);

}  // namespace cordon::estimators
