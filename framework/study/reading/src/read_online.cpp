// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/reading/read_parts.hpp"

namespace cordon::json {

namespace {

constexpr double longest_lag = 10'000;

}  // namespace

OnlineSpec read_online(const Cursor& at) {
  OnlineSpec spec;
  if (!at.expect_keys({"jumps", "longest_gap", "late", "lag", "repeated"}, "key",
                      "rules for samples out of order: {\"jumps\": \"fill\", \"late\": "
                      "\"correct\", \"repeated\": \"ignore\"}"))
    return spec;
  if (const auto jumps = at.find("jumps"))
    if (read_choice(*jumps, {"refuse", "fill"}) == "fill") spec.jumps = JumpRule::fill;
  if (const auto gap = at.find("longest_gap")) {
    spec.longest_gap = read_integer(*gap, 1, max_integer).value_or(spec.longest_gap);
    if (spec.jumps == JumpRule::refuse)
      gap->error("is of no use, as jumps are refused", "add \"jumps\": \"fill\", or leave it out");
  }
  if (const auto late = at.find("late"))
    if (read_choice(*late, {"drop", "correct"}) == "correct") spec.late = LateRule::correct;
  if (const auto lag = at.find("lag"))
    spec.lag = read_integer(*lag, 1, longest_lag).value_or(spec.lag);
  if (const auto repeated = at.find("repeated"))
    if (read_choice(*repeated, {"refuse", "ignore"}) == "ignore")
      spec.repeated = RepeatRule::ignore;
  return spec;
}

}  // namespace cordon::json
