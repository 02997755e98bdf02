// SPDX-License-Identifier: GPL-3.0-or-later
#include "time_limit.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "cordon/core/error.hpp"

namespace cordon::detail {

void TimeLimit::check(std::int64_t steps) const {
  if (!reached()) return;
  // Rounded: the run began a little after its deadline was set.
  const double seconds = std::max(0.0, std::chrono::duration<double>(*deadline_ - begin_).count());
  const std::string limit =
      seconds < 100 ? fmt::format("{:.3g}", seconds) : fmt::format("{:.0f}", seconds);
  throw Error(Errc::time_limit, fmt::format("time limit of {} s reached after {} {}", limit, steps,
                                            steps == 1 ? "step" : "steps"));
}

}  // namespace cordon::detail
