// SPDX-License-Identifier: GPL-3.0-or-later
// Eθ, the directions in which parameter uncertainty acts in the design of a gain: x⁺ = A x + … + Eθ
// θ with θ in a unit box.
#pragma once

#include <optional>
#include <vector>

#include "cordon/registry/plugin.hpp"

namespace cordon::estimators {

/// Adds the parameter "theta".
void add_theta_parameter(ParamSchema& schema);

/// The parameter, if it is there.
std::optional<Matrix> theta_from(const Params& params);

/// Adds a problem at "/theta" if it has another number of rows than there are states.
void check_theta(const Model& model, const Params& params, std::vector<Diagnostic>& problems);

/// Eθ (n×n_θ) as given; else the diagonal matrix of the row sums of A_radius, which bounds ΔA x for
/// states in the unit box; no columns where A is exact.
Matrix theta_of(const Model& model, const std::optional<Matrix>& given = {});

}  // namespace cordon::estimators
