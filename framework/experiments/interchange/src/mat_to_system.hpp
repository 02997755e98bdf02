// SPDX-License-Identifier: GPL-3.0-or-later
// Values of MATLAB as the JSON of a study.
#pragma once

#include "experiments/interchange/mat_value.hpp"
#include "json_layout.hpp"
#include "study/text/json_text.hpp"

namespace cordon::mat {

/// Is this a struct with matrices A and C?
bool is_system(const Value& value);
/// Is this a struct that says which set it is?
bool is_set(const Value& value);

/// The set of a struct. Reports what is wrong at `pointer`.
json::Json set_of(const Value& set, Index element, const std::string& pointer,
                  json::Problems& problems);
/// The system of a struct with the fields of docs/interchange.md, modes included; `ignored` gets
/// the fields that are none of them.
json::Json system_of(const Value& system, std::vector<std::string>& ignored,
                     json::Problems& problems);

/// "is complex", "is a cell array": why it is no matrix.
std::string kind_of(const Value& value);

}  // namespace cordon::mat
