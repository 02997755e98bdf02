// SPDX-License-Identifier: GPL-3.0-or-later
// What this framework was built from: for results files and `cordon doctor`.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace cordon {

struct BuildInfo {
  std::string version;  ///< of cordon
  std::string abi_tag;  ///< what a plugin must agree with
  std::vector<std::pair<std::string, std::string>>
      tools;  ///< compiler and libraries with their versions
};
BuildInfo build_info();

}  // namespace cordon
