// SPDX-License-Identifier: GPL-3.0-or-later
// An assumption that a run has found to fail, proven again.
#pragma once

#include "study/results/recorded_run.hpp"

namespace cordon::verification {

/// Is it proven from data.csv that the assumption fails there? `unknown`, too, where the files do
/// not tell enough: of other seeds than the first, and of sets that belong to a diagnoser. `no`:
/// the truth keeps to it as far as can be told.
Answer fails_again(const RecordedRun& run, const RecordedPipeline& pipeline);

}  // namespace cordon::verification
