// SPDX-License-Identifier: GPL-3.0-or-later
// A recorded design beside what is proven of its input.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cordon/study/design.hpp"

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

/// What results say of a design besides its answer.
struct SeparationRecord {
  Answer claimed = Answer::unknown;            ///< "separates" of the designer
  Answer proven_separation = Answer::unknown;  ///< "separates" of what the host has proven
  std::optional<InputDesign> proven = {};      ///< what that is, pair by pair and tube by tube
};

/// These, and what the host has recorded as proven, which has to be proven again, bound for bound;
/// "separates" has to be what pairs and tubes say.
DesignFindings compare_recorded(const ModeBank& bank, const DesignOutcome& outcome,
                                const SeparationRecord& recorded, const ExactSeparation& exact);

}  // namespace cordon::verification
