// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnoses as JSON, for the results and for programs.
#pragma once

#include <string>
#include <vector>

#include "cordon/study/run.hpp"
#include "study/text/json_writer.hpp"

namespace cordon::detail {

/// A bound of an additive fault with the true value, where that is known.
struct JudgedBound {
  FaultBound bound;
  std::optional<double> truth;
};

/// The name of a mode as a value; null for -1.
void write_mode(JsonWriter& json, std::string_view key, const std::vector<std::string>& modes,
                Index mode);

/// {min, median, max}; null if there are none.
void write_delays(JsonWriter& json, std::string_view key, const DelayStatistics& delays);

/// {candidate, consistent, residual, reset_residual, proof}; what is not offered is left out.
void write(JsonWriter& json, const ModeEvidence& evidence);

/// One of a pipeline's "events".
void write(JsonWriter& json, const DiagnosisEvent& event, const std::vector<std::string>& modes);

/// One step of results.json.
void write(JsonWriter& json, const Diagnosis& diagnosis, const std::optional<Index>& truth,
           const std::vector<JudgedBound>& faults, const std::vector<std::string>& modes);

/// The members of a summary, inside an open object.
void write_members(JsonWriter& json, const DiagnosisOutcome& outcome);

void write(JsonWriter& json, const Guarantees& guarantees, const std::vector<std::string>& modes);

void write(JsonWriter& json, const DiagnosisAssumptions& assumed,
           const std::vector<std::string>& modes);

}  // namespace cordon::detail
