// SPDX-License-Identifier: GPL-3.0-or-later
// The sweep in the resolved text of a study.
#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "study/reading/read_sweep.hpp"

namespace cordon::json {

/// What is written, without comments; integers up to 2⁵³ as such.
nlohmann::ordered_json written_json(const Value& value);

/// Adds the sweep to a resolved study, and puts what is written (`tree`: with the first value of
/// every axis) in place of what was resolved wherever a path would lose its way: into a set or a
/// matrix of another form, to the type of a component whose parameters are filled in, into the
/// system, whose parts fill in each other.
void add_sweep(nlohmann::ordered_json& resolved, const Value& tree,
               const std::vector<WrittenAxis>& axes);

}  // namespace cordon::json
