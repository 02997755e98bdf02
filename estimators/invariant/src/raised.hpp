// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/rounding.hpp"

namespace cordon::invariant {

/// A nonnegative number after a few more than n roundings to nearest, made an upper bound.
inline double raised(double value, Index n) { return value * (1 + 2 * rounding::gamma(n + 8)); }

}  // namespace cordon::invariant
