// SPDX-License-Identifier: GPL-3.0-or-later
// A recorded design beside what is proven of its input.
#pragma once

#include <atomic>
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
    std::string pointer;  ///< relative to the design
  };
  std::vector<Refuted> refuted = {};
};

/// "disjoint", bounds of κ, "meet" and "empty" by `verify_design`. A claim that tubes meet is made up to rounding: it is false
/// only if κ exceeds 1e-9. Bounds of κ have to be proven up to 1e-9 of 1 + κ, and up to
/// 1e9.
DesignFindings compare_design(const ModeBank& bank, const DesignOutcome& outcome, const ExactSeparation& exact);
inline DesignFindings check_design(const ModeBank& bank, const DesignOutcome& outcome, const std::atomic<bool>* stop) {
  return compare_design(bank, outcome, verify_design(bank, outcome, stop));
}

}  // namespace cordon::verification
