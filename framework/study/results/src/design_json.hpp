// SPDX-License-Identifier: GPL-3.0-or-later
// Designed inputs as JSON, for the results and for programs.
#pragma once

#include <string>
#include <vector>

#include "cordon/study/design.hpp"
#include "cordon/study/run.hpp"
#include "study/text/json_writer.hpp"

namespace cordon::detail {

using ModeNames = std::vector<std::string>;

/// An object.
void write(JsonWriter& json, const DesignOutcome& outcome, const ModeNames& modes);
void write(JsonWriter& json, const ExactSeparation& exact, const ModeNames& modes);

/// [{mode, runs, possible, isolated, …}].
void write(JsonWriter& json, const std::vector<ExperimentRow>& experiments, const ModeNames& modes);

}  // namespace cordon::detail
