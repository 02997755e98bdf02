// SPDX-License-Identifier: GPL-3.0-or-later
// When a search has to end, and when it should tell how far it is.
#pragma once

#include <algorithm>
#include <chrono>

#include "cordon/interfaces/input_designer.hpp"

namespace cordon::designers {

class Watch {
 public:
  Watch(DesignControl& control, Index horizon, double seconds)
      : control_(control), horizon_(horizon), end_(Clock::now() + as_duration(seconds)) {}

  bool over() const {
    ended_ = ended_ || control_.stop() || Clock::now() >= end_;
    return ended_;
  }
  /// Was that so when it was asked?
  bool ended() const { return ended_; }
  /// Seconds until the end, 0 after it.
  double left() const {
    return std::max(0.0, std::chrono::duration<double>(end_ - Clock::now()).count());
  }
  /// Passed on four times per second at most.
  void progress(double best, double bound) {
    const auto now = Clock::now();
    if (now < next_) return;
    next_ = now + std::chrono::milliseconds(250);
    control_.progress(horizon_, best, bound);
  }

 private:
  using Clock = std::chrono::steady_clock;
  /// A year at most, which no clock overflows by.
  static Clock::duration as_duration(double seconds) {
    return std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(std::min(seconds, 3e7)));
  }

  DesignControl& control_;
  Index horizon_;
  Clock::time_point end_, next_ = {};
  mutable bool ended_ = false;
};

}  // namespace cordon::designers
