// SPDX-License-Identifier: GPL-3.0-or-later
// A recorded design beside what is proven of its input.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "cordon/study/design.hpp"
#include "study/verification/recorded_run.hpp"

namespace cordon::verification {

/// Of the claims of one design: how many hold, how many are open, and those that are proven false.
struct DesignFindings {
  std::int64_t hold = 0, undecided = 0;
  std::string first_undecided = {};
  struct Refuted {
    std::string what;
    std::string pointer;  ///< relative to the pipeline
  };
  std::vector<Refuted> refuted = {};
};

/// "disjoint", bounds of κ, "meet" and "empty" by `verify_design`. A claim that tubes meet is made
/// up to rounding: it is false only if κ exceeds 1e-9. Bounds of κ have to be proven up to 1e-9 of
/// 1 + κ, and up to 1e9.
DesignFindings compare_design(const ModeBank& bank, const DesignOutcome& outcome,
                              const ExactSeparation& exact);

/// These, and of a pipeline with a design what the host has recorded as proven, which has to be
/// proven again, bound for bound; "separates" has to be what pairs and tubes say.
DesignFindings compare_recorded(const ModeBank& bank, const RecordedPipeline& recorded,
                                const ExactSeparation& exact);
inline DesignFindings check_design(const ModeBank& bank, const RecordedPipeline& recorded,
                                   const std::atomic<bool>* stop) {
  return compare_recorded(bank, recorded, verify_design(bank, *recorded.design, stop));
}

}  // namespace cordon::verification
