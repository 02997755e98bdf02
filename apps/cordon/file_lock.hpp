// SPDX-License-Identifier: GPL-3.0-or-later
// A file that one process at a time works with.
#pragma once

#include <filesystem>

namespace cordon::apps {

/// Locks a file that is made for it, as long as the object lives; the file stays. Throws InputError
/// about `what` where another process has locked it, Errc::io.
class FileLock {
 public:
  FileLock(const std::filesystem::path& file, const std::filesystem::path& what);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_ = -1;
};

/// Locks an open file. Throws InputError where another process has locked it.
void lock(int descriptor, const std::filesystem::path& what);

}  // namespace cordon::apps
