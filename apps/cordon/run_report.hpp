// SPDX-License-Identifier: GPL-3.0-or-later
// What `cordon run` prints about a finished run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common.hpp"
#include "cordon/study/run.hpp"

namespace cordon::apps {

/// A table with one row per pipeline with an observer, then gains, widths and inner estimates where
/// there are any, a timeline for each pipeline with a diagnoser, designs with their experiments,
/// and where the results are.
std::string report_text(const Study& study, const RunOutcome& outcome,
                        const std::filesystem::path& out);
std::string report_json(const Study& study, const RunOutcome& outcome);

}  // namespace cordon::apps
