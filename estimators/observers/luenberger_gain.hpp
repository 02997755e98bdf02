// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/model.hpp"

namespace cordon::estimators {

/// A gain L for x̂⁺ = A x̂ + … + L (y - ŷ): the steady state of the zonotopic Kalman filter, which minimises the F-radius of the
/// recursion at every step [Combastel2015]: with the shapes G of enclosing zonotopes, Q = Bw G_W G_Wᵀ Bwᵀ, R = Dv G_V G_Vᵀ Dvᵀ
/// and C̄ = mid(g) C, the limit of
///   S = C̄ P C̄ᵀ + R,   L = A P C̄ᵀ S⁻¹,   P ← A P Aᵀ + Q - L S Lᵀ.
/// Q and R are enlarged by 1e-6 of the largest entry of Q and R (1 if both are 0) times the identity, so that S is regular and
/// the limit stabilises wherever (A, C̄) is detectable. Throws Errc::invalid if the recursion does not converge, which is where
/// (A, C̄) is not detectable. O(n³) per step.
Matrix designed_gain(const Model& model);

/// Adds a problem at `pointer` if the given gain has another shape or leaves A - L C̄ with an eigenvalue outside the unit circle;
/// at "" if none is given and none can be designed. `of_mode` is put behind the object in messages (" of mode \"leak\"").
void check_gain(const Model& model, const Matrix* given, const std::string& pointer, const std::string& of_mode,
                std::vector<Diagnostic>& problems);

}  // namespace cordon::estimators
