// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/line_form.hpp"

namespace cordon::sets {

/// The lines of T X.
struct LineImage {
  Matrix M;  ///< those of X mapped, without what depends on others; or all of them, and unit
             ///< vectors behind them
  bool exact = true;  ///< no unit vectors
};

/// The columns of T M are eliminated with pivots that are more than `vague_column` (1e-4) of the
/// terms they cancelled from. If as many are found as T M has independent columns in exact
/// arithmetic, the others depend on them. If not, an independent direction is there that rounding
/// hides: it has entries in the coordinates that are left only, each of which becomes a line of its
/// own. Lines that stand in rows of S are kept in their order. [sets/line_zonotope.hpp, affine_sum]
LineImage line_image(MatrixIn T, const LineForm& X);

}  // namespace cordon::sets
