// SPDX-License-Identifier: GPL-3.0-or-later
// Runs one pipeline with an input designer.
#pragma once

#include "cordon/study/run.hpp"
#include "study/results/results.hpp"
#include "time_limit.hpp"

namespace cordon::detail {

/// Designs the input, and lets the diagnoser, if there is one, find out every mode of the bank from
/// experiments with it, over all seeds of the study. A design that the limit ends is kept, with the
/// error. Nothing: stopped from outside.
std::optional<PipelineOutcome> run_design(const Study& study, std::size_t index,
                                          const Registry& registry, const RunOptions& options,
                                          const TimeLimit& limit, Results* results);

}  // namespace cordon::detail
