// SPDX-License-Identifier: GPL-3.0-or-later
// Measurements as text, and as CSV.
#pragma once

#include <string>
#include <vector>

#include "curve.hpp"

namespace cordon::bench {

void print_preamble(int rounds);
/// A table of the axis with what failed or was skipped, and the exponents.
void print(const AxisResult& result);

/// One line per measurement, with a heading.
std::string csv(const std::vector<AxisResult>& results);

}  // namespace cordon::bench
