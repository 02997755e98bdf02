// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosers/mode_elimination.hpp"

#include <algorithm>

#include "saved_state.hpp"

namespace cordon::estimators {

ModeElimination::ModeElimination(Index modes, Index waiting_time, std::optional<Index> known)
    : waiting_time_(waiting_time), known_(known), candidate_(static_cast<std::size_t>(modes)) {
  start(0);
}

void ModeElimination::start(Index k) {
  reset(k, Decision::isolating);
  was_reset_ = false;
  if (known_) {
    std::fill(candidate_.begin(), candidate_.end(), false);
    candidate_[static_cast<std::size_t>(*known_)] = true;
  }
  conclude(k);
}

void ModeElimination::reset(Index k, Decision decision) {
  std::fill(candidate_.begin(), candidate_.end(), true);
  decision_ = decision;
  mode_ = -1;
  since_ = k;
  was_reset_ = true;
}

/// The decision that follows from the candidates.
void ModeElimination::conclude(Index k) {
  const bool waited = k - since_ >= waiting_time_;
  const auto left = std::count(candidate_.begin(), candidate_.end(), true);
  if (left == 1 && (decision_ != Decision::unknown_fault || waited)) {
    decision_ = Decision::monitoring;
    mode_ = std::find(candidate_.begin(), candidate_.end(), true) - candidate_.begin();
  } else if (left > 1 && waited) {
    decision_ = Decision::ambiguous;
  }
}

bool ModeElimination::update(Index k, const std::vector<bool>& excluded) {
  for (std::size_t j = 0; j < candidate_.size(); ++j) candidate_[j] = candidate_[j] && !excluded[j];
  if (std::count(candidate_.begin(), candidate_.end(), true) > 0) {
    conclude(k);
    return false;
  }
  const bool lasted =
      k - since_ >= waiting_time_ || (decision_ == Decision::monitoring && !was_reset_);
  const bool switched = lasted && decision_ != Decision::unknown_fault;
  reset(k, switched ? Decision::isolating : Decision::unknown_fault);
  return true;
}

void ModeElimination::serialize(Archive& archive) {
  const auto modes = static_cast<Index>(candidate_.size());
  serialize_flags(archive, candidate_);
  archive(decision_, was_reset_);
  serialize_within(archive, mode_, -1, modes - 1);
  serialize_time(archive, since_);
  if (decision_ == Decision::monitoring && mode_ < 0) archive.refuse("a decision without a mode");
}

}  // namespace cordon::estimators
