// SPDX-License-Identifier: GPL-3.0-or-later
#include "search_path.hpp"

#include <algorithm>
#include <cstdlib>
#include <dlfcn.h>
#include <string_view>
#include <system_error>

#include "build_info.hpp"
#include "cordon/registry/registry.hpp"

namespace cordon {

namespace {

namespace fs = std::filesystem;

/// Adds a directory once; an empty name (which other programs read as the working directory) is
/// left out.
void append(SearchPath& path, const fs::path& directory) {
  if (directory.empty()) return;
  std::error_code error;
  fs::path absolute = fs::absolute(directory, error).lexically_normal();
  if (error) return;
  if (!absolute.has_filename()) absolute = absolute.parent_path();  // "dir/" is "dir"
  for (const fs::path& known : path.directories) {
    std::error_code unknown;  // a directory that does not exist is equivalent to none
    if (known == absolute || fs::equivalent(known, absolute, unknown)) return;
  }
  path.directories.push_back(std::move(absolute));
}

const char own_address = 0;

}  // namespace

std::vector<fs::path> registry::shipped_directories() {
  SearchPath path;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) append(path, program.parent_path().parent_path() / "lib/cordon/plugins-v1");
  Dl_info library{};  // of this code: a program of somebody else may lie elsewhere
  if (dladdr(&own_address, &library) != 0 && library.dli_fname)
    append(path, fs::path(library.dli_fname).parent_path() / "cordon/plugins-v1");
  append(path, CORDON_INSTALLED_PLUGINS);
  return path.directories;
}

SearchPath default_search_path(std::span<const fs::path> extra) {
  SearchPath path;
  for (const fs::path& directory : extra) append(path, directory);
  if (const char* listed = std::getenv("CORDON_PLUGIN_PATH")) {
    for (std::string_view rest = listed; !rest.empty();) {
      const std::size_t colon = std::min(rest.find(':'), rest.size());
      append(path, rest.substr(0, colon));
      rest.remove_prefix(std::min(colon + 1, rest.size()));
    }
  }
  for (const fs::path& directory : registry::shipped_directories()) append(path, directory);
  return path;
}

}  // namespace cordon
