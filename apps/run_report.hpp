// SPDX-License-Identifier: GPL-3.0-or-later
// What `cordon run` prints about a finished run.
#pragma once

#include <filesystem>
#include <string>

#include "cordon/study/run.hpp"

namespace cordon::apps {

/// A table with one row per pipeline with an observer, a timeline for each with a diagnoser, then where the results are.
std::string report_text(const Study& study, const RunOutcome& outcome, const std::filesystem::path& out);
std::string report_json(const RunOutcome& outcome);

}  // namespace cordon::apps
