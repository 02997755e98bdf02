// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/directory_lock.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include "cordon/core/error.hpp"
#include "study/text/host.hpp"
#include "study/text/publish.hpp"

namespace cordon::detail {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse_directory(const fs::path& path, const std::string& what,
                                   const std::string& why) {
  throw Error(Errc::io, what + " " + path.string() + ": " + why);
}

/// Who holds the lock, as the file tells.
std::string holder(int descriptor) {
  std::array<char, 200> bytes;
  const ssize_t got = ::pread(descriptor, bytes.data(), bytes.size(), 0);
  std::string text;
  for (ssize_t i = 0; i < got && bytes[static_cast<std::size_t>(i)] != '\n'; ++i) {
    const char c = bytes[static_cast<std::size_t>(i)];
    text += c >= ' ' && c < 0x7f ? c : '?';
  }
  return text.empty() ? "another process" : text;
}

}  // namespace

MadeDirectories::MadeDirectories(const fs::path& directory) {
  std::vector<fs::path> missing;
  std::error_code error;
  for (fs::path at = directory; !fs::exists(at, error) && at.has_relative_path();
       at = at.parent_path())
    missing.push_back(at);
  if (missing.empty() && !fs::is_directory(directory, error)) {
    refuse_directory(directory, "cannot write results to", "it is a file; name a directory");
  }
  for (; !missing.empty(); missing.pop_back()) {
    if (missing.back().filename().empty()) continue;  // "results/": the same directory twice
    if (fs::create_directory(missing.back(), error)) {
      made_.push_back(missing.back());
    } else if (error) {
      const std::string why = error.message();
      for (; !made_.empty(); made_.pop_back()) fs::remove(made_.back(), error);
      refuse_directory(missing.back(), "cannot make the directory", why);
    }
  }
}

MadeDirectories::~MadeDirectories() {
  std::error_code ignored;
  for (; !made_.empty(); made_.pop_back()) fs::remove(made_.back(), ignored);  // only if empty
}

DirectoryLock::DirectoryLock(const fs::path& directory)
    : directory_(fs::absolute(directory).lexically_normal()),
      file_(directory_ / ".cordon-lock"),
      made_(directory_) {
  take();
  try {
    sign();
    publish(directory_);
  } catch (...) {
    release();
    throw;
  }
}

DirectoryLock::~DirectoryLock() { release(); }

/// The lock is on a file, not on the directory: network file systems lock nothing else.
void DirectoryLock::take() {
  for (;;) {
    descriptor_ =
        ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    if (descriptor_ < 0)
      refuse_directory(directory_, "cannot write results to", std::strerror(errno));
    struct stat held, there;
    if (::fstat(descriptor_, &held) != 0 || !S_ISREG(held.st_mode)) {
      ::close(std::exchange(descriptor_, -1));
      refuse_directory(file_, "cannot lock", "it is no regular file; remove it");
    }
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      const std::string who = holder(descriptor_);
      ::close(std::exchange(descriptor_, -1));
      throw InputError(directory_.string(), {{"", who + " is writing results into this directory",
                                              "wait for its end, or name another \"--out\""}});
    }
    // The holder removes the file as it goes: a lock on one that has gone keeps nobody out.
    if (::lstat(file_.c_str(), &there) == 0 && held.st_dev == there.st_dev &&
        held.st_ino == there.st_ino)
      return;
    ::close(std::exchange(descriptor_, -1));
  }
}

/// For those who come while it is held.
void DirectoryLock::sign() const {
  const std::string text = "process " + std::to_string(::getpid()) + " on " + this_host().name +
                           ", begun " + utc_now() + "\n";
  if (::ftruncate(descriptor_, 0) != 0) return;
  const ssize_t written = ::pwrite(descriptor_, text.data(), text.size(), 0);
  if (written < 0) return;  // a full disk: the lock holds without
}

void DirectoryLock::release() noexcept {
  if (descriptor_ < 0) return;
  ::unlink(file_.c_str());  // still locked: from here on a file of this name is another process's
  ::close(std::exchange(descriptor_, -1));
}

}  // namespace cordon::detail
