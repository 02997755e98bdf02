// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "study/text/json_cursor.hpp"

namespace cordon::json {

/// Reports what has no place in a system of type "nonlinear": matrices, modes, formulas beside a
/// plant, keys that nobody knows.
void expect_nonlinear_keys(const Cursor& system);

}  // namespace cordon::json
