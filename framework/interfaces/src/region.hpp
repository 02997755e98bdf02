// SPDX-License-Identifier: GPL-3.0-or-later
// Does a step keep to the region that a linear model is proven for?
#pragma once

#include <string>

#include "cordon/interfaces/model.hpp"
#include "cordon/interfaces/set.hpp"

namespace cordon::detail {

/// Which state of the hull, or input, may lie outside, and where; "": none does.
std::string why_outside(const ValidRegion& region, const Box& hull, const Sample& now);

/// Contains A X ⊕ B diag(f) u ⊕ Bw W, of a model with E = I and exactly known matrices.
Box predicted_hull(const LinearModel& model, const Set& X, const Vector& u, const Set& W);

}  // namespace cordon::detail
