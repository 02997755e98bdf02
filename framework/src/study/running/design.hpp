// SPDX-License-Identifier: GPL-3.0-or-later
// How designers are watched while they work.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>

#include "cordon/interfaces/input_designer.hpp"

namespace cordon::detail {

/// Ends a design by a flag (may be null), and passes its progress on at most twenty times a second.
class WatchedDesign final : public DesignControl {
 public:
  using Tell = std::function<void(Index, double, double)>;
  explicit WatchedDesign(const std::atomic<bool>* stop, Tell tell = {}) : stop_(stop), tell_(std::move(tell)) {}

  bool stop() const noexcept override { return stop_ && stop_->load(); }
  void progress(Index horizon, double best, double bound) override {
    if (!tell_ || Clock::now() - told_ < std::chrono::milliseconds(50)) return;
    told_ = Clock::now();
    tell_(horizon, best, bound);
  }

 private:
  using Clock = std::chrono::steady_clock;

  const std::atomic<bool>* stop_;
  Tell tell_;
  Clock::time_point told_ = {};
};

}  // namespace cordon::detail
