// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "experiments/report/figure.hpp"

namespace cordon::report {

/// One HTML file that needs nothing else and asks for nothing: the figures, their data, and what
/// draws them. Whatever stands in the report is shown as text. Numbers are rounded to six digits of
/// what their figure can show.
std::string page_of(const Report& report);

}  // namespace cordon::report
