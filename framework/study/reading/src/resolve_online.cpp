// SPDX-License-Identifier: GPL-3.0-or-later
#include "resolve_online.hpp"

#include "study/reading/read_parts.hpp"

namespace cordon::json {

nlohmann::ordered_json resolved_online(const OnlineSpec& spec) {
  nlohmann::ordered_json online;
  online["jumps"] = jump_rule_names()[static_cast<std::size_t>(spec.jumps)];
  if (spec.jumps == JumpRule::fill) online["longest_gap"] = spec.longest_gap;
  online["late"] = late_rule_names()[static_cast<std::size_t>(spec.late)];
  online["lag"] = spec.lag;
  online["repeated"] = repeat_rule_names()[static_cast<std::size_t>(spec.repeated)];
  online["clock_tolerance"] = spec.clock_tolerance;
  online["clock_drift"] = spec.clock_drift;
  return online;
}

}  // namespace cordon::json
