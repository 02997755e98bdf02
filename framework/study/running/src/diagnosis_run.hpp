// SPDX-License-Identifier: GPL-3.0-or-later
// Runs one pipeline with a diagnoser.
#pragma once

#include "cordon/study/run.hpp"
#include "study/results/results.hpp"
#include "study/running/run_on.hpp"
#include "time_limit.hpp"

namespace cordon::detail {

/// Over all seeds of the study, the first of which is written. Nothing: stopped from outside.
std::optional<PipelineOutcome> run_diagnosis(const OpenData& open, const Study& study,
                                             std::size_t index, const Registry& registry,
                                             const RunOptions& options, const TimeLimit& limit,
                                             Results* results);

/// How many seeds diagnosers are tried on.
std::int64_t seeds_of(const Study& study);

/// What the program relies on in a diagnosis. Throws Errc::plugin.
void check_fits(const Diagnosis& diagnosis, const ModeBank& bank, const std::string& diagnoser);

}  // namespace cordon::detail
