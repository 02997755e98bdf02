// SPDX-License-Identifier: GPL-3.0-or-later
// The zonotopic Kalman gain, which minimises the F-radius of the next set [Combastel2015]. With the
// shapes G of zonotopes around W and V, Q = Bw G_W G_Wᵀ Bwᵀ, R = Dv G_V G_Vᵀ Dvᵀ, C̄ = mid(g) C and
// the covariation P of the set of states:
//   L = A P C̄ᵀ S⁻¹,   S = C̄ P C̄ᵀ + R.
#pragma once

#include "gains/gain_form.hpp"

namespace cordon::estimators {

/// L for a set of covariation P (n×n). Where S is singular, R is enlarged by 1e-6 of the largest
/// entry of S (1 if S is 0). O(n³), and two linear programs per noise where V is no zonotope.
Matrix kalman_gain(const Model& model, MatrixIn P);

/// The limit of L under P ← A P Aᵀ + Q - L S Lᵀ, with Q and R enlarged by 1e-6 of the largest entry
/// of Q and R (1 if both are 0) times the identity, so that S is regular and the limit stabilises
/// wherever (A, C̄) is detectable. Throws Errc::invalid if it does not converge, which is where (A,
/// C̄) is not detectable, and the errors of W and V that no zonotope contains. The filter's is Λ = P
/// C̄ᵀ S⁻¹ of the same P, that of predicted sets; L = A Λ. O(n³) per step.
Matrix steady_kalman_gain(const Model& model, GainForm form = GainForm::predictor);

}  // namespace cordon::estimators
