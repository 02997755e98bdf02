// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace cordon::detail {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// When a run gives its pipelines up.
class TimeLimit {
 public:
  /// Of a run that begins now; nothing: never.
  explicit TimeLimit(std::optional<Clock::time_point> deadline)
      : begin_(Clock::now()), deadline_(deadline) {}

  bool reached() const { return deadline_ && Clock::now() >= *deadline_; }
  /// Throws Errc::time_limit once it is reached.
  void check(std::int64_t steps) const;

 private:
  Clock::time_point begin_;
  std::optional<Clock::time_point> deadline_;
};

}  // namespace cordon::detail
