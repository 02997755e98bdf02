// SPDX-License-Identifier: GPL-3.0-or-later
// Points that are outside a set by more than rounding.
#pragma once

#include "cordon/core/line_form.hpp"

namespace cordon::detail {

/// Is x proven to lie outside X, with all that is within `margin` of it in every coordinate? By a
/// certificate that the box around x and X are disjoint.
bool clearly_outside(const LineForm& X, VectorIn x, double margin);
bool clearly_outside(const LineForm& X, VectorIn x, VectorIn margin);

/// The same with 1e-9 of the larger of x and of X without its lines, coordinate by coordinate, for
/// they have units of their own, and 1e-14 of the largest coordinate: states and inputs may be made
/// of numbers of that size.
bool clearly_outside(const LineForm& X, VectorIn x);

/// The same with 1e-9 of the largest coordinate of all, in estimates, whose coordinates are
/// computed from each other; and with `rounding`, a bound per coordinate of what rounding errors
/// have moved an estimate by (RoundingMargin).
bool outside_by_its_size(const LineForm& X, VectorIn x, VectorIn rounding);

/// Is x proven to lie in X, if every row of X may be off by 1e-6 of its terms, and every coordinate
/// by 1e-6 of the larger of x and X? Exact arithmetic; false where the set is too large for it.
bool barely_outside(const LineForm& X, VectorIn x);

}  // namespace cordon::detail
