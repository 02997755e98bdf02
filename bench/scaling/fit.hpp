// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace cordon::bench {

/// The slope of log(values) over log(sizes) by least squares, over the upper half of the sizes
/// (ascending). Nothing, where fewer than three sizes or a value that is not positive are left.
std::optional<double> exponent(const std::vector<double>& sizes, const std::vector<double>& values);

/// Two decimals; "–" for nothing.
std::string exponent_text(const std::optional<double>& exponent);

}  // namespace cordon::bench
