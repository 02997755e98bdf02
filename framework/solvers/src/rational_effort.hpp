// SPDX-License-Identifier: GPL-3.0-or-later
// Which questions rational arithmetic is asked: those that it answers within about a second.
#pragma once

#include "cordon/core/types.hpp"

namespace cordon {

bool is_small(MatrixIn S, MatrixIn A);  ///< to solve the rows for a point
bool has_few_lines(MatrixIn S,
                   MatrixIn A);  ///< to move multipliers onto the equations of the lines

}  // namespace cordon
