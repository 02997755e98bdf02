// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/running/time_limit.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cordon/core/error.hpp"

namespace cordon::detail {

void TimeLimit::check(std::int64_t steps) const {
  if (!reached()) return;
  // In hundredths: the run began a little after its deadline was set.
  const double seconds = std::round(100 * std::max(0.0, std::chrono::duration<double>(*deadline_ - begin_).count())) / 100;
  throw Error(Errc::time_limit,
              fmt::format("time limit of {} s reached after {} {}", seconds, steps, steps == 1 ? "step" : "steps"));
}

}  // namespace cordon::detail
