// SPDX-License-Identifier: GPL-3.0-or-later
// What went wrong in a run, in words and as an exit code.
#pragma once

#include <string>
#include <vector>

#include "common.hpp"
#include "cordon/study/run.hpp"

namespace cordon::apps {

/// What went wrong, a sentence each: pipelines that stopped, guarantees that were violated.
std::vector<std::string> complaints(const Study& study, const RunOutcome& outcome);
/// The code of the worst outcome: a violated guarantee before errors of pipelines.
Exit exit_of(const RunOutcome& outcome);

}  // namespace cordon::apps
