// SPDX-License-Identifier: GPL-3.0-or-later
// The libraries of a directory, and the announcements beside them: `NAME.provides` tells what
// `NAME.so` holds, so that a missing or refused plugin can be named.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "cordon/registry/registry.hpp"

namespace cordon::registry {

/// The components that `NAME.provides` beside a library announces, a line each; none if there is no
/// such file.
std::vector<std::string> announced(const std::filesystem::path& library);
/// The `*.so` of a directory, absolute and sorted.
std::vector<std::filesystem::path> libraries_in(const std::filesystem::path& directory,
                                                std::error_code& error);
/// Libraries that are announced and not there.
std::vector<std::filesystem::path> announced_without_file(const std::filesystem::path& directory);
PluginReport missing(const std::filesystem::path& library);

}  // namespace cordon::registry
