// SPDX-License-Identifier: GPL-3.0-or-later
// How a set of files becomes visible.
#pragma once

#include <filesystem>
#include <functional>

namespace cordon::detail {

/// Of a target: complete files with their manifest, which are its results from the moment this
/// folder has its name.
inline constexpr const char* committed_folder = ".committed";

/// Renames a file and tells whether it could, like std::rename.
using Rename = std::function<int(const char* from, const char* to)>;
int rename_file(const char* from, const char* to);

/// Moves what is in TARGET/.committed, if there is such a folder, into TARGET: first the manifest,
/// so that a reader of whatever comes later sees that it has changed, then the files. Before that,
/// files of earlier results that the manifest does not list go. Can be ended at any time and begun
/// again. The caller holds the target's lock. Throws InputError, Errc::io.
void publish(const std::filesystem::path& target, const Rename& rename = rename_file);

/// Is there anything of this name, a broken link included?
bool is_there(const std::filesystem::path& path);

/// Waits until the names in a directory are on the disk, where the file system can; files are there
/// already.
void sync_names(const std::filesystem::path& directory);

}  // namespace cordon::detail
