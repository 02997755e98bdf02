// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "catalogue.hpp"
#include "cordon/registry/registry.hpp"
#include "library.hpp"

namespace cordon::registry {

struct LoadedPlugin {
  LibraryPtr library;
  std::filesystem::path file;
};
using LoadedPlugins = std::map<std::string, LoadedPlugin, std::less<>>;

/// Checks and opens one library and adds its components: all of them but those whose names somebody
/// else has, or none and a report that says why. `file` is absolute. Throws nothing of the
/// plugin's; on refusal the library is closed again.
PluginReport load_plugin(const std::filesystem::path& file, LoadedPlugins& plugins,
                         Catalogue& catalogue);

/// Does the name stand in the file as a word of its own?
bool file_holds_name(const std::filesystem::path& file, std::string_view name);

}  // namespace cordon::registry
