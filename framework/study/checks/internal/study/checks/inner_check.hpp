// SPDX-License-Identifier: GPL-3.0-or-later
// Inner estimates beside the hulls that must hold them.
#pragma once

#include <optional>

#include "cordon/core/box.hpp"

namespace cordon::detail {

class InnerCheck {
 public:
  /// The inner estimate of time k. Throws Errc::plugin for what is no box of the hull's dimension.
  void step(Index k, const Box& inner, const Box& hull);

  std::int64_t steps() const { return steps_; }
  /// First k at which it leaves the hull by more than 1e-9 of the larger one's size (at least of
  /// 1); -1: never.
  std::int64_t outside() const { return outside_; }
  /// Mean of width of the inner estimate / width of the hull over steps and states, where that is a
  /// number; NaN: nowhere.
  double share() const;

 private:
  std::int64_t steps_ = 0, outside_ = -1, shares_ = 0;
  double sum_ = 0;
};

/// Does `inner` leave `hull` by more than rounding?
bool leaves(const Box& inner, const Box& hull);

}  // namespace cordon::detail
