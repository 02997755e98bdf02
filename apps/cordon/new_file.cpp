// SPDX-License-Identifier: GPL-3.0-or-later
#include "new_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <unistd.h>

#include <fmt/format.h>

#include "cordon/core/error.hpp"

namespace cordon::apps {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& file, int reason) {
  if (reason == EEXIST)
    throw Error(Errc::invalid, fmt::format("{} exists already; give another name", file.string()));
  throw Error(Errc::io, fmt::format("cannot write {}: {}", file.string(), std::strerror(reason)));
}

}  // namespace

void write_new_file(const fs::path& file, const std::string& content) {
  if (std::error_code error; fs::exists(fs::symlink_status(file, error))) fail(file, EEXIST);
  const fs::path partial =
      file.parent_path() / fmt::format(".partial-{}-{}", getpid(), file.filename().string());
  errno = 0;
  std::ofstream stream(partial, std::ios::binary);
  stream << content;
  stream.close();
  int reason = stream ? 0 : std::max(errno, 1);
  if (reason == 0 &&
      renameat2(AT_FDCWD, partial.c_str(), AT_FDCWD, file.c_str(), RENAME_NOREPLACE) != 0)
    reason = errno;
  if (reason == EINVAL || reason == ENOSYS)
    reason = std::rename(partial.c_str(), file.c_str()) == 0 ? 0 : errno;
  if (reason == 0) return;
  std::error_code ignored;
  fs::remove(partial, ignored);
  fail(file, reason);
}

}  // namespace cordon::apps
