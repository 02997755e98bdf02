// SPDX-License-Identifier: GPL-3.0-or-later
// What is printed about how often and how soon diagnosers were right.
#pragma once

#include <string>
#include <vector>

#include "common.hpp"
#include "cordon/study/run.hpp"

namespace cordon::apps {

/// "outside the bank" for -1.
std::string mode_name(const std::vector<std::string>& modes, Index mode);

/// "1 run", "20 runs".
std::string runs_text(std::int64_t runs);

/// Delays and counts over all seeds, where the data tell the true mode.
std::string score_text(const Study& study, const DiagnosisOutcome& found, const Paint& paint);

}  // namespace cordon::apps
