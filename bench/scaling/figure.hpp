// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "curve.hpp"

namespace cordon::bench {

/// An SVG of the time of a step against each axis, all logarithmic, with the exponents under the
/// panels.
std::string figure(const std::vector<AxisResult>& results);

}  // namespace cordon::bench
