// SPDX-License-Identifier: GPL-3.0-or-later
// Which modes of a bank are left, and what to call it. Pure logic: it knows no sets, and rests on
// one assumption that no bank can do without: a mode lasts at least the waiting time.
#pragma once

#include <optional>
#include <vector>

#include "cordon/interfaces/archive.hpp"
#include "cordon/interfaces/diagnoser.hpp"

namespace cordon::estimators {

/// Exclusions are statements about the time from `since()` on; a reset begins a new time and makes
/// every mode a candidate again.
/// - monitoring m: m excluded: reset, then `isolating`. But `unknown_fault` if m was isolated since
/// a reset less than the waiting
///   time ago: every mode of the bank is then excluded over a time shorter than any mode lasts.
/// - isolating: one candidate left: `monitoring` it. None left: reset, `unknown_fault`, for the
/// same reason. Several left
///   after the waiting time: `ambiguous`.
/// - ambiguous: one candidate left: `monitoring` it. None left: reset, `isolating`, as the mode may
/// have changed in that time.
/// - unknown_fault: none left: reset again. One left after the waiting time: `monitoring` it;
/// several: `ambiguous`.
class ModeElimination {
 public:
  /// `known` is the mode that is assumed at the start; none: every mode is a candidate.
  ModeElimination(Index modes, Index waiting_time, std::optional<Index> known);

  /// Begins at time k.
  void start(Index k);

  /// `excluded[j]`: proven by the samples up to k that the plant has not been in mode j throughout
  /// from since() to k. Entries of modes that are no candidates are ignored. True: a reset, the
  /// caller begins anew with every mode at time k.
  bool update(Index k, const std::vector<bool>& excluded);

  void serialize(Archive& archive);

  Decision decision() const { return decision_; }
  Index mode() const {
    return decision_ == Decision::monitoring ? mode_ : -1;
  }  ///< -1 unless `monitoring`
  Index since() const { return since_; }
  bool is_candidate(Index j) const { return candidate_[static_cast<std::size_t>(j)]; }

 private:
  void reset(Index k, Decision decision);
  void conclude(Index k);

  Index waiting_time_;
  std::optional<Index> known_;
  std::vector<bool> candidate_;
  Decision decision_ = Decision::isolating;
  Index mode_ = -1, since_ = 0;
  bool was_reset_ = false;
};

}  // namespace cordon::estimators
