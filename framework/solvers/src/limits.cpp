// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/limits.hpp"

#include <algorithm>
#include <utility>

namespace cordon {

namespace {

thread_local LimitedSolvers* of_thread = nullptr;

}  // namespace

LimitedSolvers::LimitedSolvers(const SolverLimits& limits)
    : limits_(limits), outer_(std::exchange(of_thread, this)) {
  const auto& outer = outer_ ? outer_->limits_.deadline : std::nullopt;
  if (outer) limits_.deadline = std::min(limits_.deadline.value_or(*outer), *outer);
}

LimitedSolvers::~LimitedSolvers() {
  of_thread = outer_;
  tell_left_open(left_open_);
}

void LimitedSolvers::tell_left_open(bool left_open) {
  if (of_thread && left_open) of_thread->left_open_ = true;
}

SolverLimits LimitedSolvers::of_this_thread() {
  SolverLimits limits;
  if (!of_thread) return limits;
  limits.deadline = of_thread->limits_.deadline;
  for (const LimitedSolvers* at = of_thread; at && !limits.programs; at = at->outer_)
    limits.programs = at->limits_.programs;
  return limits;
}

bool LimitedSolvers::may_begin() {
  if (is_over()) return false;
  LimitedSolvers* counts = of_thread;
  while (counts && !counts->limits_.programs) counts = counts->outer_;
  if (!counts || counts->begun_ < *counts->limits_.programs) {
    if (counts) ++counts->begun_;
    return true;
  }
  of_thread->left_open_ = true;
  return false;
}

bool LimitedSolvers::is_over() {
  if (!of_thread || !of_thread->limits_.deadline) return false;
  if (SolverLimits::Clock::now() < *of_thread->limits_.deadline) return false;
  of_thread->left_open_ = true;
  return true;
}

int LimitedSolvers::milliseconds_left(int most) {
  if (!of_thread || !of_thread->limits_.deadline) return most;
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
                        *of_thread->limits_.deadline - SolverLimits::Clock::now())
                        .count();
  return static_cast<int>(std::clamp<long long>(left, 1, std::max(1, most)));
}

}  // namespace cordon
