// SPDX-License-Identifier: GPL-3.0-or-later
// What is known of a separation problem, whichever search found it.
#pragma once

#include <optional>

#include "cordon/core/types.hpp"

namespace cordon::designers {

struct KnownAnswer {
  std::optional<Vector> u;  ///< the cheapest input so far that is proven to separate every pair
                            ///< with κ ≥ ε (at ε = 0 they may touch)
  double cost = infinity;
  double bound = 0;  ///< proven: no input of U that leaves no tube empty costs less

  void offer(const Vector& input, double its_cost) {
    if (u && its_cost >= cost) return;
    u = input;
    cost = its_cost;
  }
  void raise(double proven) { bound = std::max(bound, std::min(proven, cost)); }
};

}  // namespace cordon::designers
