// SPDX-License-Identifier: GPL-3.0-or-later
// Do data keep to the formulas of a model?
#pragma once

#include "cordon/interfaces/model.hpp"
#include "cordon/study/data.hpp"

namespace cordon::detail {

/// Is it proven that no w in the hull of W leads from one record to the next, but for this share of
/// the next state? False also where a formula is not defined there.
bool no_disturbance_leads(const Model& model, const Record& before, const Record& now,
                          double share);

/// The same of v in the hull of V, by the outputs that there are; without a share also where the
/// invariants do not hold exactly.
bool no_noise_shows(const Model& model, const Record& now, double share);

/// Are the invariants proven not to be met, by more than the true state may be off by rounding?
bool misses_invariants(const Model& model, const Record& now);

}  // namespace cordon::detail
