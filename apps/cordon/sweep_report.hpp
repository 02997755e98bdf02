// SPDX-License-Identifier: GPL-3.0-or-later
// What `cordon run` and `cordon merge` print about a finished sweep.
#pragma once

#include <filesystem>
#include <string>

#include "cordon/experiments/sweep.hpp"
#include "cordon/study/comparison_table.hpp"

namespace cordon::apps {

/// The comparison as text: the best cells of each group have a "*", groups are an empty line apart.
/// At most `limit` rows.
std::string comparison_text(const ComparisonTable& table, std::size_t limit);

/// Title, comparison of the pipelines over the repetitions, points that failed, and where the files
/// are; `has_page`: report.html is among them.
std::string sweep_report_text(const SweepOutcome& outcome, const std::filesystem::path& out,
                              bool has_page = true);
std::string sweep_report_json(const SweepOutcome& outcome);

}  // namespace cordon::apps
