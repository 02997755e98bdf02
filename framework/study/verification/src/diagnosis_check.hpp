// SPDX-License-Identifier: GPL-3.0-or-later
// Exclusions of modes, and bounds of the state in one, proven again.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "cordon/study/verify.hpp"
#include "study/results/recorded_run.hpp"

namespace cordon::verification {

/// Of a diagnosis with assumptions: whether its decisions follow from its exclusions, and whether
/// these and what it tells of the state follow from equations, bounds and samples. By linear rows
/// over the last samples that every trajectory keeps to, with multipliers whose sum is checked in
/// rational arithmetic; of linear models up to n = 4 where these do not do, by exact polytopes,
/// which also refute what is false. Counts go to `found`; returned is the first violation.
/// `goes_on` is asked before each sample; false: the check ends there.
std::optional<Violation> check_diagnosis(const RecordedRun& run, std::size_t pipeline,
                                         const VerifyOptions& options, VerifiedPipeline& found,
                                         const std::function<bool(std::int64_t done)>& goes_on);

}  // namespace cordon::verification
