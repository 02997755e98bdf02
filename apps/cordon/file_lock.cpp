// SPDX-License-Identifier: GPL-3.0-or-later
#include "file_lock.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <fmt/format.h>

#include "cordon/core/error.hpp"

namespace cordon::apps {

void lock(int descriptor, const std::filesystem::path& what) {
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return;
  if (errno != EWOULDBLOCK) return;  // a file system without locks
  throw InputError(what.string(), {{"", "another stream works with it",
                                    "end that one first, or name another file"}});
}

FileLock::FileLock(const std::filesystem::path& file, const std::filesystem::path& what)
    : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0)
    throw Error(Errc::io, fmt::format("{}: {}", file.string(), std::strerror(errno)));
  try {
    lock(descriptor_, what);
  } catch (const Error&) {
    ::close(descriptor_);
    throw;
  }
}

FileLock::~FileLock() { ::close(descriptor_); }

}  // namespace cordon::apps
