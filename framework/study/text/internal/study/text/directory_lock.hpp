// SPDX-License-Identifier: GPL-3.0-or-later
// One writer at a time in a directory of results.
#pragma once

#include <filesystem>
#include <vector>

namespace cordon::detail {

/// Makes a directory with those above it that are missing; destroyed, it removes those of them that
/// are empty. Throws Errc::io.
class MadeDirectories {
 public:
  explicit MadeDirectories(const std::filesystem::path& directory);
  ~MadeDirectories();
  MadeDirectories(const MadeDirectories&) = delete;
  MadeDirectories& operator=(const MadeDirectories&) = delete;

 private:
  std::vector<std::filesystem::path> made_;  ///< outermost first
};

/// Holds a directory, which is made if it is missing, by a lock on its file .cordon-lock; the file
/// goes with the object. What a writer that has died while it put its results in place has left is
/// finished first. Throws InputError: another process holds it, and which; Errc::io: the file
/// cannot be written. Where the file system knows no locks, nobody is kept out.
class DirectoryLock {
 public:
  explicit DirectoryLock(const std::filesystem::path& directory);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

  const std::filesystem::path& directory() const { return directory_; }

 private:
  void take();
  void sign() const;
  void release() noexcept;

  std::filesystem::path directory_, file_;
  MadeDirectories made_;
  int descriptor_ = -1;
};

}  // namespace cordon::detail
