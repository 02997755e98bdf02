// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace cordon::detail {

/// Where and when a run took place: what makes times comparable. Unknown parts are "".
struct Host {
  std::string name, system, cpu;
};
Host this_host();

std::string utc_now();  ///< ISO 8601, "2026-01-31T12:00:00Z"

}  // namespace cordon::detail
