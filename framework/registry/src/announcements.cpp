// SPDX-License-Identifier: GPL-3.0-or-later
#include "announcements.hpp"

#include <algorithm>
#include <fstream>

namespace cordon::registry {

namespace fs = std::filesystem;

namespace {

/// The files of a directory whose names end in `extension`, absolute and sorted.
std::vector<fs::path> files_of(const fs::path& directory, const char* extension,
                               std::error_code& error) {
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code relative;
    if (entry->path().extension() == extension)
      files.push_back(fs::absolute(entry->path(), relative).lexically_normal());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::vector<std::string> announced(const fs::path& library) {
  constexpr std::size_t most = 1000,
                        most_bytes = std::size_t{1} << 20;  // the file is input like any other
  const fs::path name = fs::path(library).replace_extension(".provides");
  std::vector<std::string> components;
  std::error_code error;
  if (!fs::is_regular_file(name, error) || fs::file_size(name, error) > most_bytes)
    return components;
  std::ifstream file(name);
  for (std::string line; components.size() < most && std::getline(file, line);) {
    if (!line.empty() && line.size() < 200) components.push_back(line);
  }
  return components;
}

std::vector<fs::path> libraries_in(const fs::path& directory, std::error_code& error) {
  return files_of(directory, ".so", error);
}

std::vector<fs::path> announced_without_file(const fs::path& directory) {
  std::error_code ignored;
  std::vector<fs::path> files = files_of(directory, ".provides", ignored);
  for (fs::path& file : files) file.replace_extension(".so");
  std::erase_if(files, [&](const fs::path& library) {
    return fs::symlink_status(library, ignored).type() != fs::file_type::not_found;
  });
  return files;
}

PluginReport missing(const fs::path& library) {
  PluginReport report;
  report.file = library;
  report.name = library.stem().string();
  report.reason =
      "the file is missing, though " + library.stem().string() + ".provides beside it announces it";
  report.fix = "build or install the plugin again, or delete the announcement too";
  report.components = announced(library);
  return report;
}

}  // namespace cordon::registry
