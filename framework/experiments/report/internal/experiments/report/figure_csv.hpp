// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "experiments/report/figure.hpp"

namespace cordon::report {

/// The numbers of a figure as a table with a header, one row per point, vertex, span, interval or
/// row.
std::string csv_of(const Figure& figure, const Report& report);

}  // namespace cordon::report
