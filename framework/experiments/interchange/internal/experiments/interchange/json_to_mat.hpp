// SPDX-License-Identifier: GPL-3.0-or-later
// JSON values as values of MATLAB.
#pragma once

#include "experiments/interchange/mat_value.hpp"
#include "study/text/json_text.hpp"

namespace cordon::mat {

/// null is NaN, "inf" and "-inf" are numbers; a list of numbers is a row, a list of such lists of
/// equal length a matrix, any other list a cell array; an object is a struct. A set in exchange
/// form gets columns c and b.
Value to_mat(const json::Value& value);

/// A number, null, "inf" or "-inf" as a number.
bool is_number(const json::Value& value);
double number_of(const json::Value& value);

}  // namespace cordon::mat
