// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/interfaces/gain_designer.hpp"

namespace cordon::estimators {

/// What a gain L (n×n_y) is worth, whoever found it: a bound of the spectral radius and signs of A
/// - L C̄, C̄ = mid(g) C, proven for the numbers that A, L and C̄ hold, and bounds of ‖(zI - (A - L
/// C̄))⁻¹ [Eθ, Bw G_W, -L Dv G_V]‖∞ with `theta` as Eθ (n rows, or 0×0 for none) and the shapes G of
/// zonotopes around W and V, the rounding of its products included; no bounds where W or V has
/// none. `objective` and what belongs to it are left to the designer.
GainCertificate certify(const Model& model, const Matrix& L, const Matrix& theta);

/// C̄ = mid(g) C.
Matrix mean_outputs(const LinearModel& model);

/// C, with zero rows where the mean gain of a sensor is zero: what diag(mean) C shows, without its
/// rounding. Scaling a row changes what gains exist by its factor only.
Matrix shown_outputs(const LinearModel& model);

/// Why L is no gain for the model: another shape, entries that are no numbers, or A - L C̄ not
/// proven to have all eigenvalues inside the unit circle; "" if it is one.
std::string gain_problem(const Model& model, const Matrix& L);

}  // namespace cordon::estimators
