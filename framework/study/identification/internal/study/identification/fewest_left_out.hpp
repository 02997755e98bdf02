// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest number of samples without which a factor does for the others.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "cordon/study/identify.hpp"

namespace cordon::identification {

struct FewestLeftOut {
  std::optional<std::set<Index>> samples;  ///< by their k; fewer than were known
  Index at_least = 0;                      ///< proven: with fewer, a larger factor is required
};

/// A set of samples that is proven to require a larger factor than `wanted` has to lose one of its
/// own: the smallest hitting set of these sets [Reiter1987] is searched for, by depth, each of them
/// found by a linear program and proven in rational arithmetic. `factors` answers for what is
/// left without some samples; `known` samples suffice, and `at_least` so many are proven to be
/// needed. After `most_programs`, or where a proof does not succeed, what is proven by then is
/// told.
FewestLeftOut fewest_left_out(const std::function<BoundFactors(const std::set<Index>&)>& factors,
                              double wanted, Index known, Index at_least, Index most_programs,
                              const std::function<bool()>& stop);

}  // namespace cordon::identification
