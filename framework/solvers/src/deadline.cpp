// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/deadline.hpp"

#include <algorithm>
#include <utility>

namespace cordon {

namespace {

thread_local Deadline* deadline_of_this_thread = nullptr;

}  // namespace

Deadline::Deadline(Clock::time_point at)
    : at_(at), outer_(std::exchange(deadline_of_this_thread, this)) {
  if (outer_) at_ = std::min(at_, outer_->at_);
}

Deadline::~Deadline() {
  deadline_of_this_thread = outer_;
  if (outer_ && has_ended_any_) outer_->has_ended_any_ = true;
}

bool Deadline::is_over() {
  Deadline* const own = deadline_of_this_thread;
  if (!own || Clock::now() < own->at_) return false;
  own->has_ended_any_ = true;
  return true;
}

int Deadline::milliseconds_left(int most) {
  const Deadline* const own = deadline_of_this_thread;
  if (!own) return most;
  const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(own->at_ - Clock::now()).count();
  return static_cast<int>(std::clamp<long long>(left, 1, std::max(1, most)));
}

}  // namespace cordon
