// SPDX-License-Identifier: GPL-3.0-or-later
// Parameters of formulas: numbers, and those of which bounds are known.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/reading/read_parts.hpp"

namespace cordon::json {

/// Reads /system/parameters into `written`; every name is shown to `take_name`.
void read_parameters(const Cursor& system,
                     const std::function<void(const Cursor&, const std::string&)>& take_name,
                     WrittenFormulas& written);

/// Those of them that keep their value, or those that vary and stand in one of the formulas.
std::vector<ParameterRange> constant_ranges(const WrittenFormulas& written);
std::vector<ParameterRange> varying_ranges(const WrittenFormulas& written,
                                           const std::vector<std::string>& formulas);

/// The box of all their values.
LineForm box_of(const std::vector<ParameterRange>& ranges);

}  // namespace cordon::json
