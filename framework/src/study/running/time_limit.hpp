// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace cordon::detail {

/// When a run gives its pipelines up.
class TimeLimit {
 public:
  using Clock = std::chrono::steady_clock;

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
