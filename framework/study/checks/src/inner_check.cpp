// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/checks/inner_check.hpp"

#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/core/tolerances.hpp"

namespace cordon::detail {

bool leaves(const Box& inner, const Box& hull) {
  if (hull.is_empty()) return true;
  for (Index i = 0; i < hull.dim(); ++i) {
    double size = 1;
    for (const double bound : {inner.lower[i], inner.upper[i], hull.lower[i], hull.upper[i]}) {
      if (std::isfinite(bound)) size = std::max(size, std::abs(bound));
    }
    const double margin = tolerances::reported * size;
    if (inner.lower[i] < hull.lower[i] - margin || inner.upper[i] > hull.upper[i] + margin)
      return true;
  }
  return false;
}

void InnerCheck::step(Index k, const Box& inner, const Box& hull) {
  const bool fits = inner.lower.size() == hull.dim() && inner.upper.size() == hull.dim();
  if (!fits || !(inner.lower.array() <= inner.upper.array()).all()) {
    throw Error(Errc::plugin,
                "the observer gave an inner estimate that is no box of its states at k = " +
                    std::to_string(k));
  }
  ++steps_;
  if (outside_ < 0 && leaves(inner, hull)) outside_ = k;
  if (hull.is_empty()) return;
  for (Index i = 0; i < hull.dim(); ++i) {
    const double share = (inner.upper[i] - inner.lower[i]) / (hull.upper[i] - hull.lower[i]);
    if (!std::isfinite(share)) continue;
    sum_ += share;
    ++shares_;
  }
}

double InnerCheck::share() const {
  return shares_ > 0 ? sum_ / static_cast<double>(shares_)
                     : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace cordon::detail
