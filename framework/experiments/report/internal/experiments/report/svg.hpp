// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "experiments/report/figure.hpp"

namespace cordon::report {

/// The figure as an SVG file for a paper: no scripts, no fonts of its own. A projection shows up to
/// six of its times.
std::string svg_of(const Figure& figure, const Report& report);

}  // namespace cordon::report
