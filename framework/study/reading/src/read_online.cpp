// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/reading/read_parts.hpp"
#include "study/text/numbers.hpp"

namespace cordon::json {

namespace {

constexpr double longest_lag = 10'000;

/// The rule of that name; of no such one, the first.
template <class Rule>
void read_rule(const Cursor& at, const char* key, const std::vector<std::string>& names,
               Rule& rule) {
  const auto given = at.find(key);
  if (given && read_choice(*given, names) == names[1]) rule = static_cast<Rule>(1);
}

/// What a clock may be wrong by.
void read_share(const Cursor& at, const char* key, double& share) {
  const auto given = at.find(key);
  if (!given) return;
  const double value = read_number(*given).value_or(share);
  if (value >= 0 && value < 0.5) {
    share = value;
  } else {
    given->error("must be from 0 to below 0.5, and is " + detail::to_text(value),
                 "times may miss those of the plant by a share of the sampling time, and run fast "
                 "or slow by a share");
  }
}

}  // namespace

const std::vector<std::string>& jump_rule_names() {
  static const std::vector<std::string> names{"refuse", "fill"};
  return names;
}

const std::vector<std::string>& late_rule_names() {
  static const std::vector<std::string> names{"drop", "correct"};
  return names;
}

const std::vector<std::string>& repeat_rule_names() {
  static const std::vector<std::string> names{"refuse", "ignore"};
  return names;
}

OnlineSpec read_online(const Cursor& at) {
  OnlineSpec spec;
  if (!at.expect_keys(
          {"jumps", "longest_gap", "late", "lag", "repeated", "clock_tolerance", "clock_drift"},
          "key",
          "rules for samples out of order: {\"jumps\": \"fill\", \"late\": "
          "\"correct\", \"repeated\": \"ignore\"}"))
    return spec;
  read_rule(at, "jumps", jump_rule_names(), spec.jumps);
  read_rule(at, "late", late_rule_names(), spec.late);
  read_rule(at, "repeated", repeat_rule_names(), spec.repeated);
  if (const auto gap = at.find("longest_gap")) {
    spec.longest_gap = read_integer(*gap, 1, max_integer).value_or(spec.longest_gap);
    if (spec.jumps == JumpRule::refuse)
      gap->error("is of no use, as jumps are refused", "add \"jumps\": \"fill\", or leave it out");
  }
  if (const auto lag = at.find("lag"))
    spec.lag = read_integer(*lag, 1, longest_lag).value_or(spec.lag);
  read_share(at, "clock_tolerance", spec.clock_tolerance);
  read_share(at, "clock_drift", spec.clock_drift);
  return spec;
}

}  // namespace cordon::json
