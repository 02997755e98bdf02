// SPDX-License-Identifier: GPL-3.0-or-later
// What results.json holds of an observer beside its steps: members, inside an open object.
#pragma once

#include <vector>

#include "cordon/study/run.hpp"
#include "study/text/json_writer.hpp"

namespace cordon::detail {

/// "gains": [{name, type, matrix, spectral_radius, monotone, norm {lower, upper}, objective,
/// optimum, optimum_bound, margin}]; the last four only where something was optimised. What is not
/// known is null.
void write(JsonWriter& json, const std::vector<Gain>& gains);

/// "last": {k, hull, width}, width being null for the empty set; null if there was no step.
void write_last(JsonWriter& json, Index k, const Box& hull);

/// "inner_steps", "inner_share", "inner_outside".
void write_inner(JsonWriter& json, const EstimationOutcome& outcome);
void write_growth(JsonWriter& json, const EstimationOutcome& outcome);

/// NAME: [outputs, from 1 on].
void write_outputs(JsonWriter& json, const char* name, const std::vector<Index>& outputs);
/// "contradiction": {k, output, distance} of the first empty estimate; "restarts"; "not_enclosed":
/// {times, from, reason}; "outliers": {samples, left_out: [{k, outputs, output, distance}]}: those
/// that there are.
void write_contradictions(JsonWriter& json, const EstimationOutcome& outcome);

}  // namespace cordon::detail
