// SPDX-License-Identifier: GPL-3.0-or-later
// Models that are proven in a region only, held at all times.
#pragma once

#include <vector>

#include "cordon/core/error.hpp"
#include "diagnosers/observer_bank/error_dynamics.hpp"

namespace cordon::estimators {

/// Problems where a mode's model is proven in a region only and the plant is not shown to keep to
/// it, whatever modes it goes through: by induction over k, if the bounds of its state by all of
/// these linear models and the inputs of U lie in the region of each.
std::vector<Diagnostic> check_regions(const ModeBank& bank, const std::vector<Matrix>& gains,
                                      const OfflineOptions& options);

}  // namespace cordon::estimators
