// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/study/result_table.hpp"
#include "experiments/interchange/mat_value.hpp"
#include "study/text/json_text.hpp"

namespace cordon::mat {

/// The steps of a pipeline in results.json, a list of objects, as fields with a column per step: k,
/// lower, upper, consistent, exact and metrics of observers; decision, mode, modes, faults and
/// others of diagnosers.
void add_steps(Struct& pipeline, const std::vector<json::Value>& steps);

/// The points of a sweep as columns.
Value to_mat(const ResultTable& table);

}  // namespace cordon::mat
