// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/atomic_directory.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cordon/core/error.hpp"

namespace cordon::detail {

namespace fs = std::filesystem;

namespace {

constexpr const char* prefix = ".partial-";

[[noreturn]] void refuse_file(const fs::path& path, const std::string& what,
                              const std::string& why) {
  throw Error(Errc::io, what + " " + path.string() + ": " + why);
}

int open_directory(const fs::path& path) {
  return ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
}

bool same_directory(int descriptor, const fs::path& path) {
  struct stat held, there;
  return ::fstat(descriptor, &held) == 0 && ::lstat(path.c_str(), &there) == 0 &&
         held.st_dev == there.st_dev && held.st_ino == there.st_ino;
}

/// No signal is delivered to this thread while it lives.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_;
};

}  // namespace

AtomicDirectory::AtomicDirectory(fs::path target, bool whole, Rename rename)
    : target_(fs::absolute(target).lexically_normal()),
      whole_(whole),
      rename_(std::move(rename)),
      made_(target_) {
  try {
    remove_leftovers();
    make_partial();
  } catch (...) {
    discard();
    throw;
  }
}

AtomicDirectory::AtomicDirectory(fs::path target)
    : AtomicDirectory(std::move(target), false, rename_file) {}

AtomicDirectory::AtomicDirectory(const DirectoryLock& lock, Rename rename)
    : AtomicDirectory(lock.directory(), true, std::move(rename)) {}

AtomicDirectory::~AtomicDirectory() { discard(); }

void AtomicDirectory::remove_leftovers() const {
  std::error_code error;
  for (fs::directory_iterator entry(target_, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!entry->path().filename().string().starts_with(prefix)) continue;
    const int owner = open_directory(entry->path());
    if (owner < 0) continue;
    std::error_code ignored;
    if (::flock(owner, LOCK_EX | LOCK_NB) == 0)
      fs::remove_all(entry->path(), ignored);  // nobody alive holds it
    ::close(owner);
  }
}

void AtomicDirectory::make_partial() {
  for (int n = 0; n < 10000; ++n) {
    const fs::path path = target_ / (prefix + std::to_string(::getpid()) + "-" + std::to_string(n));
    if (::mkdir(path.c_str(), 0777) != 0) {
      if (errno == EEXIST) continue;
      refuse_file(target_, "cannot write results to", std::strerror(errno));
    }
    lock_ = open_directory(path);
    const bool taken = lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (lock_ >= 0 && !taken && same_directory(lock_, path)) {
      partial_ = path;
      return;
    }
    if (lock_ >= 0) ::close(lock_);  // another process took it for a leftover
    lock_ = -1;
  }
  refuse_file(target_, "cannot write results to", "no free name for a temporary directory");
}

OutputFile& AtomicDirectory::create(const std::string& name) {
  files_.emplace_back(name, std::make_unique<OutputFile>(partial_ / name));
  return *files_.back().second;
}

void AtomicDirectory::write_manifest() {
  std::vector<ManifestEntry> entries;
  for (const auto& [name, file] : files_) entries.push_back(file->entry());
  OutputFile manifest(partial_ / manifest_name);
  manifest.write(manifest_text(entries));
  manifest.close();
}

std::vector<fs::path> AtomicDirectory::commit() {
  std::vector<fs::path> results;
  for (const auto& [name, file] : files_) {
    std::error_code ignored;
    if (fs::is_directory(target_ / name, ignored))
      refuse_file(target_ / name, "cannot replace", "it is a directory");
    file->close();
    results.push_back(target_ / name);
  }
  if (std::error_code ignored; whole_ && fs::is_directory(target_ / manifest_name, ignored)) {
    refuse_file(target_ / manifest_name, "cannot replace", "it is a directory");
  }
  const SignalsBlocked blocked;
  if (whole_) {
    const fs::path committed = target_ / committed_folder;
    write_manifest();
    sync_names(partial_);
    if (rename_(partial_.c_str(), committed.c_str()) != 0)
      refuse_file(committed, "cannot make", std::strerror(errno));
    partial_.clear();  // from here on these are the results
    sync_names(target_);
    publish(target_, rename_);
  } else {
    for (const auto& [name, file] : files_) {
      const fs::path final = target_ / name;
      if (rename_((partial_ / name).c_str(), final.c_str()) != 0)
        refuse_file(final, "cannot replace", std::strerror(errno));
    }
    sync_names(target_);
  }
  discard();
  return results;
}

void AtomicDirectory::discard() noexcept {
  files_.clear();
  std::error_code ignored;
  if (!partial_.empty()) fs::remove_all(partial_, ignored);
  partial_.clear();
  if (lock_ >= 0) ::close(lock_);
  lock_ = -1;
}

}  // namespace cordon::detail
