// SPDX-License-Identifier: GPL-3.0-or-later
#include "file_lock.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "cordon/core/error.hpp"

namespace cordon::apps {

void lock(int descriptor, const std::filesystem::path& file) {
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return;
  if (errno != EWOULDBLOCK) return;  // a file system without locks
  throw InputError(file.string(), {{"", "another stream works with it",
                                    "end that one first, or name another file"}});
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void FileLock::take(const std::filesystem::path& file) {
  const int opened = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (opened < 0) throw Error(Errc::io, fmt::format("{}: {}", file.string(), std::strerror(errno)));
  try {
    lock(opened, file);
  } catch (const Error&) {
    ::close(opened);
    throw;
  }
  if (const int before = std::exchange(descriptor_, opened); before >= 0) ::close(before);
}

bool FileLock::holds(const std::filesystem::path& file) const {
  if (descriptor_ < 0) return true;
  struct stat locked {
  }, named{};
  return ::fstat(descriptor_, &locked) == 0 && ::stat(file.c_str(), &named) == 0 &&
         locked.st_dev == named.st_dev && locked.st_ino == named.st_ino;
}

}  // namespace cordon::apps
