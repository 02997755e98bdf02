// SPDX-License-Identifier: GPL-3.0-or-later
#include "identify_options.hpp"

#include <charconv>
#include <utility>
#include <vector>

#include "cordon/core/error.hpp"

namespace cordon::apps {

namespace {

const std::vector<std::pair<std::string, Scaled>>& scales() {
  static const std::vector<std::pair<std::string, Scaled>> all{{"both", Scaled::both},
                                                               {"W", Scaled::disturbances},
                                                               {"V", Scaled::noises},
                                                               {"each", Scaled::each}};
  return all;
}

}  // namespace

Scaled scale_from(const std::string& name) {
  for (const auto& [known, scaled] : scales())
    if (known == name) return scaled;
  throw Error(Errc::invalid, "--scale takes both, W, V or each, not \"" + name + "\"");
}

double share_from(const std::string& text, const char* option) {
  double percent = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, percent);
  const bool is_share = error == std::errc() && std::string(rest, end) == "%";
  if (!is_share || !(percent > 0) || percent > 100)
    throw Error(Errc::invalid,
                std::string(option) + " takes a share, 70% for example, not \"" + text + "\"");
  return percent / 100;
}

void check(const IdentifyArguments& arguments) {
  scale_from(arguments.scale);
  share_from(arguments.train, "--train");
  margin_of(arguments);
}

double margin_of(const IdentifyArguments& arguments) {
  return arguments.margin.empty() ? 0 : share_from(arguments.margin, "--margin");
}

}  // namespace cordon::apps
