// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/sets/strip.hpp"

namespace cordon::sets {

/// λ of the method for generators G and the strip |ρᵀx - d| ≤ σ; every λ gives an enclosure. 0:
/// leave the zonotope. `sigma` is to hold the rounding errors of ρᵀx as well: a λ that only they
/// make look good is then no good choice.
Vector strip_gain(MatrixIn G, VectorIn rho, double sigma, StripMethod method);

}  // namespace cordon::sets
