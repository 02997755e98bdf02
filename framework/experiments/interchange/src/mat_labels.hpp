// SPDX-License-Identifier: GPL-3.0-or-later
// Names of coordinates and the time of a step, as fields of a system.
#pragma once

#include "cordon/study/labels.hpp"
#include "experiments/interchange/mat_value.hpp"
#include "study/text/json_cursor.hpp"
#include "study/text/json_text.hpp"

namespace cordon::mat {

/// "names", a struct of cell arrays, and "sampling_time", as far as they are known.
void add_labels(Struct& system, const Labels& labels);
/// The same fields of a struct, and "Ts" or "dt" of other programs, as a study has them.
void read_labels(const Value& value, json::Json& system, json::Problems& problems);

}  // namespace cordon::mat
