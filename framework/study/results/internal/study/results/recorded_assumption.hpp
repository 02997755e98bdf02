// SPDX-License-Identifier: GPL-3.0-or-later
// An assumption that a run has found to fail, read from its results.
#pragma once

#include <optional>
#include <string>

#include "cordon/study/run.hpp"
#include "study/reading/read_parts.hpp"
#include "study/text/json_cursor.hpp"

namespace cordon::verification {

/// What to do about results that nobody wrote like this.
inline const std::string not_as_written =
    "the file is not as \"cordon run\" wrote it; run the study again";

struct RecordedAssumption {
  FailedAssumption failed;
  std::string text;  ///< for people, as the run has told it
};

/// "failed_assumption" of a summary; nothing where none has failed. Problems are told to the
/// cursor.
std::optional<RecordedAssumption> read_failed_assumption(const json::Cursor& summary,
                                                         const json::SystemPart& system);

}  // namespace cordon::verification
