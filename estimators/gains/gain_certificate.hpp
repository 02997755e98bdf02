// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/invariant/schur.hpp"
#include "gains/gain_form.hpp"

namespace cordon::estimators {

/// A - L 𝒞, with what is proven of it; in the filter's form by bounds alone, so that it may be open
/// whether a loop at the limit is stable.
invariant::ClosedLoop loop_of_errors(const LinearModel& model, const Matrix& L, GainForm form);

/// What a gain L (n×n_y) is worth, whoever found it: a bound of the spectral radius and signs of A
/// - L 𝒞 (gain_form.hpp; the predictor's is A - L C̄), proven for the numbers that A, L and C̄ hold,
/// and bounds of ‖(zI - (A - L 𝒞))⁻¹ (ℰ - L 𝒩)‖∞ with `theta` as Eθ (n rows, or 0×0 for none), the
/// rounding of its products included; no bounds where W or V has no zonotope around it. `objective`
/// and what belongs to it are left to the designer.
GainCertificate certify(const Model& model, const Matrix& L, const Matrix& theta,
                        GainForm form = GainForm::predictor);

/// C̄ = mid(g) C.
Matrix mean_outputs(const LinearModel& model);

/// C, with zero rows where the mean gain of a sensor is zero: what diag(mean) C shows, without its
/// rounding. Scaling a row changes what gains exist by its factor only.
Matrix shown_outputs(const LinearModel& model);

/// Why L is no gain for the model: another shape, entries that are no numbers, or A - L 𝒞 not
/// proven to have all eigenvalues inside the unit circle; "" if it is one.
std::string gain_problem(const Model& model, const Matrix& L, GainForm form = GainForm::predictor);

}  // namespace cordon::estimators
