// SPDX-License-Identifier: GPL-3.0-or-later
// What an affine function leaves out of a formula, over a whole box.
#pragma once

#include <span>

#include "cordon/formulas/box_enclosure.hpp"

namespace cordon::formulas {

/// {F_row(z) - slope · z : z ∈ box} ⊆ bounds.
struct Deviation {
  Interval bounds;    ///< the real line where a part of the box has no enclosure
  Interval attained;  ///< hull of values at points, computed to nearest: no bounds are narrower
  std::size_t parts = 1;
};

/// By branch and bound: the box is bisected where the bounds reach farthest, along the variable in
/// which the row is farthest from affine, until both of them are within `tolerance` of the width
/// that is attained, or there are `most_parts` parts. O(most_parts) enclosures of the function.
/// Excess: O(ε²) for parts of radius ε.
Deviation bound_deviation(BoxEnclosure& function, Index row, const Eigen::RowVectorXd& slope,
                          std::span<const Interval> box, std::size_t most_parts = 1000,
                          double tolerance = 1e-3);

}  // namespace cordon::formulas
