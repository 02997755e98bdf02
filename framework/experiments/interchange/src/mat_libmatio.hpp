// SPDX-License-Identifier: GPL-3.0-or-later
// Variables in a MAT-file as libmatio writes and reads them. A damaged file may bring down the
// process that reads it.
#pragma once

#include "experiments/interchange/mat_value.hpp"

namespace cordon::mat {

/// Writes a compressed file of version 5. Throws Errc::invalid if a variable is too large for the
/// format.
void write_variables(const char* path, const Variables& variables);

/// What cannot be used is `refused`. Throws Errc::invalid for a file that is none, or holds too
/// much.
Variables read_variables(const char* path);

}  // namespace cordon::mat
