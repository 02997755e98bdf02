// SPDX-License-Identifier: GPL-3.0-or-later
// How much work solvers may do: what they do not finish stays open.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace cordon {

struct SolverLimits {
  using Clock = std::chrono::steady_clock;
  std::optional<Clock::time_point> deadline = {};  ///< when programs end
  std::optional<std::int64_t> programs = {};       ///< that are begun at most
};

/// As long as it lives, these limits hold for the programs that its thread solves, and what they
/// were to answer beyond them stays open: questions become `unknown`, and bounds as wide as is
/// known without them. No answer is wrong by it. What is not a question to a solver goes on, as
/// does the search of programs with integers. Nested: the first deadline holds, and the innermost
/// number of programs. It is destroyed on the thread that made it.
class LimitedSolvers {
 public:
  explicit LimitedSolvers(const SolverLimits& limits);
  LimitedSolvers(const LimitedSolvers&) = delete;
  LimitedSolvers& operator=(const LimitedSolvers&) = delete;
  ~LimitedSolvers();

  /// Has a program been left open by these limits, or by outer ones meanwhile?
  bool left_open() const { return left_open_; }
  /// Those of this thread, for another one that works for it: each has the whole number of
  /// programs.
  static SolverLimits of_this_thread();
  /// Has another thread left programs open for this one?
  static void tell_left_open(bool left_open);

  /// For solvers, before each program: may it begin? It counts.
  static bool may_begin();
  /// For solvers, while they work: is the deadline over?
  static bool is_over();
  /// Milliseconds that are left, 1 at least and `most` at most.
  static int milliseconds_left(int most);

 private:
  SolverLimits limits_;
  std::int64_t begun_ = 0;  ///< programs, if this object limits their number
  LimitedSolvers* outer_;
  bool left_open_ = false;
};

}  // namespace cordon
