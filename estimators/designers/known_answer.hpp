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
  /// Does no input cost less than this one by more than a share `gap`, given a lower bound?
  bool is_met_by(double lower, double gap) const { return u && lower >= cost - gap * cost; }
  bool is_closed(double gap) const { return is_met_by(bound, gap); }
  void raise(double proven) { bound = std::max(bound, std::min(proven, cost)); }
};

}  // namespace cordon::designers
