// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "study/reading/read_parts.hpp"

namespace cordon::json {

/// A system of type "nonlinear": its formulas, names and sets. A system of one mode.
SystemPart read_nonlinear(const Cursor& system, std::vector<std::string>& warnings);

}  // namespace cordon::json
