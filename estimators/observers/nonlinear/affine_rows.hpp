// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cordon/formulas/box_enclosure.hpp"

namespace cordon::estimators {

/// Several rows of an enclosure as offset + slope z ± radius. Rows are enclosed.
struct AffineRows {
  Matrix slope;
  Vector offset, radius;
};

AffineRows affine_rows(const formulas::BoxEnclosure& enclosure, const std::vector<Index>& rows);

/// 0 … count - 1
std::vector<Index> all_rows(Index count);

}  // namespace cordon::estimators
