// SPDX-License-Identifier: GPL-3.0-or-later
// Subsets of {0, …, g-1} in lexicographic order.
#pragma once

#include <algorithm>
#include <numeric>

#include "cordon/core/recycled.hpp"
#include "cordon/core/types.hpp"

namespace cordon::sets {

/// min(C(g, k), limit + 1).
inline Index subset_count(Index g, Index k, Index limit) {
  if (k > g) return 0;
  k = std::min(k, g - k);
  double count = 1;
  for (Index i = 1; i <= k; ++i) {
    count = count * static_cast<double>(g - k + i) / static_cast<double>(i);
    if (count > static_cast<double>(limit)) return limit + 1;
  }
  return static_cast<Index>(count + 0.5);
}

/// Calls `visit` with every k-subset of {0, …, g-1}, 0 ≤ k ≤ g.
template <class Visit>
void for_each_subset(Index g, Index k, Visit visit) {
  RecycledVector<Index> subset(static_cast<std::size_t>(k));
  std::iota(subset.begin(), subset.end(), Index{0});
  while (true) {
    visit(subset);
    Index last = k - 1;
    while (last >= 0 && subset[static_cast<std::size_t>(last)] == g - k + last) --last;
    if (last < 0) return;
    Index next = ++subset[static_cast<std::size_t>(last)];
    for (Index i = last + 1; i < k; ++i) subset[static_cast<std::size_t>(i)] = ++next;
  }
}

}  // namespace cordon::sets
