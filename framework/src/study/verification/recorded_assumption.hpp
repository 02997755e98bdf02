// SPDX-License-Identifier: GPL-3.0-or-later
// An assumption that a run has found to fail, read from its results and proven again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "cordon/study/run.hpp"
#include "study/reading/json_cursor.hpp"
#include "study/reading/read_parts.hpp"

namespace cordon::verification {

struct RecordedPipeline;
struct RecordedRun;

struct RecordedAssumption {
  FailedAssumption failed;
  std::string text;  ///< for people, as the run has told it
};

/// "failed_assumption" of a summary; nothing where none has failed. Problems are told to the
/// cursor.
std::optional<RecordedAssumption> read_failed_assumption(const json::Cursor& summary,
                                                         const json::SystemPart& system);

/// Is it proven from data.csv that the assumption fails there? `unknown`, too, where the files do
/// not tell enough: of other seeds than the first, and of sets that belong to a diagnoser. `no`:
/// the truth keeps to it as far as can be told.
Answer fails_again(const RecordedRun& run, const RecordedPipeline& pipeline);

}  // namespace cordon::verification
