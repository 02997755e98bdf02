// SPDX-License-Identifier: GPL-3.0-or-later
// When questions to solvers end without an answer.
#pragma once

#include <chrono>

namespace cordon {

/// As long as it lives, programs that its thread solves end at this time, and what they were to
/// answer stays open: questions become `unknown`, and bounds as wide as is known without them. No
/// answer is wrong by it. What is not a question to a solver goes on. Deadlines may be nested: the
/// first one counts. It is destroyed on the thread that made it.
class Deadline {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Deadline(Clock::time_point at);
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;
  ~Deadline();

  /// Has a program ended by it, or by an outer one?
  bool has_ended_any() const { return has_ended_any_; }

  /// Of this thread: is it over? For solvers, which end then.
  static bool is_over();
  /// Milliseconds that are left, 1 at least and `most` at most.
  static int milliseconds_left(int most);

 private:
  Clock::time_point at_;
  Deadline* outer_;
  bool has_ended_any_ = false;
};

}  // namespace cordon
