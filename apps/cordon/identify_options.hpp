// SPDX-License-Identifier: GPL-3.0-or-later
// What `cordon identify` is asked for.
#pragma once

#include <filesystem>
#include <string>

#include "cordon/study/identify.hpp"

namespace cordon::apps {

struct IdentifyArguments {
  std::filesystem::path study, write, figure;
  std::string scale = "both", train = "100%", margin, pipeline;
  Index leave_out = 0;
  bool trade_off = false, json = false;
};

/// Throws before any work what the functions below would.
void check(const IdentifyArguments& arguments);

Scaled scale_from(const std::string& name);

/// "70%": 0.7. A number alone could be either.
double share_from(const std::string& text, const char* option);
double margin_of(const IdentifyArguments& arguments);  ///< 0 without --margin

}  // namespace cordon::apps
