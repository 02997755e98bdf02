// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

namespace cordon::registry {

/// Where the program's own plugins are: beside it, and in the installed directory.
std::vector<std::filesystem::path> shipped_directories();

}  // namespace cordon::registry
