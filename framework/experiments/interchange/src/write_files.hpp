// SPDX-License-Identifier: GPL-3.0-or-later
// Writing of files that were asked for by name.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "cordon/experiments/interchange.hpp"

namespace cordon::detail {

/// Writes files side by side, all or none; they replace what is there only if asked for. Throws
/// Errc::invalid, Errc::io.
void write_files(const std::vector<std::pair<std::filesystem::path, std::string>>& files,
                 bool replace);

}  // namespace cordon::detail
