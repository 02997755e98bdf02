// SPDX-License-Identifier: GPL-3.0-or-later
#include "write_files.hpp"

#include "cordon/core/error.hpp"
#include "study/text/atomic_directory.hpp"

namespace cordon::detail {

namespace fs = std::filesystem;

void write_files(const std::vector<std::pair<fs::path, std::string>>& files, bool replace) {
  const fs::path folder = fs::absolute(files.front().first).lexically_normal().parent_path();
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw Error(Errc::invalid, folder.string() + " is no directory; create it first");
  for (const auto& [path, content] : files) {
    const fs::file_status status = fs::symlink_status(path, error);
    if (fs::is_directory(status))
      throw Error(Errc::invalid, path.string() + " is a directory; name a file");
    if (replace || !fs::exists(status)) continue;
    throw Error(Errc::invalid,
                path.string() + " exists already; give another name, or --force to replace it");
  }
  AtomicDirectory directory(folder);
  for (const auto& [path, content] : files)
    directory.create(path.filename().string()).write(content);
  directory.commit();
}

}  // namespace cordon::detail
