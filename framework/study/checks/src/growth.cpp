// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/checks/growth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cordon::detail {

namespace {

constexpr Index start_samples = 10;
constexpr double growth_factor = 10;
/// Narrower than this share of the bounds a hull is flat: rounding, not a width to compare with.
constexpr double flat = 1e-12;

}  // namespace

void GrowthWatch::step(Index k, const Box& hull) {
  if (k < start_samples || hull.is_empty()) return;
  widths_.resize(static_cast<std::size_t>(hull.dim()));
  for (Index i = 0; i < hull.dim(); ++i) {
    Width& width = widths_[static_cast<std::size_t>(i)];
    const double now = hull.upper[i] - hull.lower[i];
    if (!(now < infinity)) continue;
    width.last = now;
    width.largest = std::max(width.largest, now);
    const double size = std::max(std::abs(hull.lower[i]), std::abs(hull.upper[i]));
    if (!(now > flat * size)) continue;
    width.recent[static_cast<std::size_t>(width.samples++) % width.recent.size()] = {k, now};
    if (width.samples < static_cast<Index>(width.recent.size())) continue;
    const double lasting = std::ranges::max(width.recent, {}, &Sample::width).width;
    if (width.smallest_at >= 0 && lasting >= width.smallest) continue;
    width.smallest = lasting;
    width.smallest_at = std::ranges::min(width.recent, {}, &Sample::k).k;
  }
}

std::optional<WidthGrowth> GrowthWatch::growth() const {
  std::optional<WidthGrowth> most;
  for (std::size_t i = 0; i < widths_.size(); ++i) {
    const Width& width = widths_[i];
    if (width.smallest_at < 0 || width.last < width.largest / 2) continue;
    const double factor = width.last / width.smallest;
    if (factor < growth_factor || (most && most->factor >= factor)) continue;
    most =
        WidthGrowth{static_cast<Index>(i), width.smallest_at, width.smallest, width.last, factor};
  }
  return most;
}

}  // namespace cordon::detail

namespace cordon {

std::string advice_on(const WidthGrowth&) {
  return "either the outputs do not bound this state and the plant lets errors grow, or what "
         "reductions add in every step adds "
         "up: allow more generators (max_generators; of constrained sets max_constraints too), use "
         "\"reduction\": \"adaptive\" or \"qr\", "
         "or an observer with a gain that "
         "makes A - L C stable and a widening_limit";
}

}  // namespace cordon
