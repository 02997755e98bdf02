// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/publish.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

#include "cordon/core/error.hpp"
#include "earlier_results.hpp"
#include "study/text/manifest.hpp"

namespace cordon::detail {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
  throw Error(Errc::io, "cannot " + what + " " + path.string() + ": " + std::strerror(errno));
}

/// Files of earlier results in the target that are none of the new ones.
void remove_outdated(const fs::path& target, const std::vector<ManifestEntry>& files) {
  for (const std::string& name : files_of_earlier_results(target)) {
    const bool is_new = std::any_of(files.begin(), files.end(),
                                    [&](const ManifestEntry& file) { return file.name == name; });
    const fs::path path = target / name;
    if (!is_new && ::unlink(path.c_str()) != 0 && errno != ENOENT && errno != EISDIR)
      fail(path, "remove");
  }
}

}  // namespace

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

int rename_file(const char* from, const char* to) { return std::rename(from, to); }

void publish(const fs::path& target, const Rename& rename) {
  const fs::path folder = target / committed_folder, manifest = target / manifest_name,
                 fresh = folder / manifest_name;
  std::error_code error;
  const fs::file_status status = fs::symlink_status(folder, error);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) {
    throw InputError(
        folder.string(),
        {{"", "stands where results are put in place, and is no directory", "remove it"}});
  }
  if (is_there(fresh)) {
    remove_outdated(target, read_manifest(fresh));
    if (rename(fresh.c_str(), manifest.c_str()) != 0) fail(manifest, "replace");
  }
  if (is_there(manifest)) {
    for (const ManifestEntry& file : read_manifest(manifest)) {
      const fs::path from = folder / file.name, to = target / file.name;
      if (is_there(from) && rename(from.c_str(), to.c_str()) != 0) fail(to, "replace");
    }
  }
  sync_names(target);
  fs::remove_all(folder, error);
  if (error) throw Error(Errc::io, "cannot remove " + folder.string() + ": " + error.message());
}

void sync_names(const fs::path& directory) {
  const int descriptor = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace cordon::detail
