// SPDX-License-Identifier: GPL-3.0-or-later
// What an affine function leaves out of formulas, over a whole box.
#pragma once

#include <span>

#include "cordon/formulas/box_enclosure.hpp"

namespace cordon::formulas {

/// {weights · (F(z) - slopes z) : z ∈ box} ⊆ bounds.
struct Deviation {
  Interval bounds;    ///< the real line where a part of the box has no enclosure
  Interval attained;  ///< hull of values at points, computed to nearest: no bounds are narrower
  std::size_t parts = 1;
};

/// By branch and bound: the box is bisected where the bounds reach farthest, along the variable in
/// which the rows are farthest from affine, until both of them are within a thousandth of the width
/// that is attained, or there are `most_parts` parts. `weights`: of the rows; `slopes`: a row for
/// each. O(most_parts) enclosures of the function. Excess: O(ε²) for parts of radius ε.
Deviation bound_deviation(BoxEnclosure& function, VectorIn weights, MatrixIn slopes,
                          std::span<const Interval> box, std::size_t most_parts = 1000);

/// weights · (F(z) - slopes z) at a point of all variables, to nearest; NaN where it is not
/// defined.
double deviation_at(Evaluator& evaluator, VectorIn weights, MatrixIn slopes,
                    std::span<const Interval> point);

}  // namespace cordon::formulas
