// SPDX-License-Identifier: GPL-3.0-or-later
// What trials of library files have shown is kept in this process and, where it lasts, in the
// user's cache directory: $XDG_CACHE_HOME/cordon or ~/.cache/cordon. Of bounded size; where nothing
// can be written, files are tried in every process.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "refusal.hpp"

namespace cordon::registry {

/// Everything that a verdict depends on: the file's path, inode, size, time and content, and this
/// build of the framework.
struct FileIdentity {
  FileIdentity(const std::filesystem::path& file, const std::string& bytes);

  std::string slot;  ///< name of its place in the cache, by the path; places are few and used again
  std::string text;
};

struct Verdict {
  std::optional<Refusal> refusal;
};
std::optional<Verdict> recall(const FileIdentity& file);
/// `lasting`: in the cache as well.
void remember(const FileIdentity& file, const Verdict& verdict, bool lasting);

}  // namespace cordon::registry
