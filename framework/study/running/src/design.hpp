// SPDX-License-Identifier: GPL-3.0-or-later
// How designers are watched while they work.
#pragma once

#include <chrono>
#include <functional>

#include "cordon/interfaces/input_designer.hpp"

namespace cordon::detail {

/// Ends a design when it is told to, and passes its progress on at most twenty times a second.
class WatchedDesign final : public DesignControl {
 public:
  using Tell = std::function<void(Index, double, double)>;
  explicit WatchedDesign(std::function<bool()> stop, Tell tell = {})
      : stop_(std::move(stop)), tell_(std::move(tell)) {}

  bool stop() const noexcept override {
    stopped_ = stopped_ || stop_();
    return stopped_;
  }
  /// Has the design been told to end?
  bool stopped() const noexcept { return stopped_; }
  void progress(Index horizon, double best, double bound) override {
    if (!tell_ || Clock::now() - told_ < std::chrono::milliseconds(50)) return;
    told_ = Clock::now();
    tell_(horizon, best, bound);
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::function<bool()> stop_;
  mutable bool stopped_ = false;
  Tell tell_;
  Clock::time_point told_ = {};
};

}  // namespace cordon::detail
