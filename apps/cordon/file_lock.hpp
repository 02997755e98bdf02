// SPDX-License-Identifier: GPL-3.0-or-later
// A file that one process at a time works with.
#pragma once

#include <filesystem>
#include <utility>

namespace cordon::apps {

class FileLock {
 public:
  FileLock() = default;
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  /// Locks the file, which has to be there, in place of the one before. Throws InputError where
  /// another process has locked it, Errc::io.
  void take(const std::filesystem::path& file);
  /// Is what has this name still the file that was locked, or was none locked?
  bool holds(const std::filesystem::path& file) const;
  void swap(FileLock& other) noexcept { std::swap(descriptor_, other.descriptor_); }

 private:
  int descriptor_ = -1;
};

/// Throws InputError where another process has locked it.
void lock(int descriptor, const std::filesystem::path& file);

}  // namespace cordon::apps
