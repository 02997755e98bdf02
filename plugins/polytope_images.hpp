// SPDX-License-Identifier: GPL-3.0-or-later
// Images of polytopes under matrices that are known up to intervals.
#pragma once

#include "cordon/core/interval_matrix.hpp"
#include "cordon/solvers/polytope.hpp"

namespace cordon::plugins {

/// conv{A x : A ∈ [A], x ∈ X} of a bounded set that is not empty. Where signs of x are fixed, |x|
/// is linear, and so are the corners mid(A) x ± rad(A) |x| of [A] x: 2ⁿ parts with 2ᵐ images each.
/// Errc::unsupported as Polytope.
Polytope hull_of_images(const Polytope& X, const IntervalMatrix& A);

}  // namespace cordon::plugins
