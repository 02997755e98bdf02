// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "cordon/core/types.hpp"

namespace cordon::estimators {

/// λ for which <·, [(I - λ C) G, σ λ]> has the least volume, |1 - C λ| Σ_S |det G_S| +
/// σ Σ_T |det [λ, G_T]| over subsets S of n and T of n - 1 columns: a linear program [Alamo2005].
/// Nothing for n > 3, more than 500 subsets T, or where the solver finds none.
std::optional<Vector> least_volume_gain(const Matrix& G, const Eigen::RowVectorXd& C, double sigma);

}  // namespace cordon::estimators
