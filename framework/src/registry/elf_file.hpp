// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "registry/refusal.hpp"

namespace cordon::registry {

/// Looks at a file before the loader maps it: a regular, readable ELF shared object of this machine whose segments and tables lie
/// within the file. The loader itself does not check the last point and dies of SIGBUS on a truncated library. Reads headers
/// only: O(segments).
std::optional<Refusal> check_library_file(const std::filesystem::path& file);

}  // namespace cordon::registry
