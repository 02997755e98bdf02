// SPDX-License-Identifier: GPL-3.0-or-later
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>
#include <utility>

#include "cordon/core/error.hpp"
#include "study/text/atomic_directory.hpp"

namespace cordon::detail {

namespace {

constexpr std::size_t buffer_size = 1 << 16;

[[noreturn]] void fail(const std::filesystem::path& path, int reason) {
  const std::string suggestion =
      reason == ENOSPC || reason == EDQUOT ? "; free some space or write elsewhere" : "";
  throw Error(Errc::io, "cannot write " + path.string() + ": " + std::strerror(reason) +
                            suggestion + "; earlier results are unchanged");
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path path)
    : path_(std::move(path)),
      descriptor_(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) fail(path_, errno);
  buffer_.reserve(buffer_size);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(std::string_view bytes) {
  buffer_ += bytes;
  if (buffer_.size() >= buffer_size) flush();
}

void OutputFile::flush() {
  std::string_view rest = buffer_;
  hash_.add(rest);
  bytes_ += static_cast<std::int64_t>(rest.size());
  while (!rest.empty()) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path_, errno);
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

ManifestEntry OutputFile::entry() const {
  return {path_.filename().string(), bytes_, hash_.digits()};
}

void OutputFile::close() {
  if (descriptor_ < 0) return;
  flush();
  int result = ::fsync(descriptor_);
  while (result != 0 && errno == EINTR) result = ::fsync(descriptor_);
  if (result != 0 && errno != EINVAL && errno != EROFS)
    fail(path_, errno);  // those two: not a file that can be synchronised
  const int closing = std::exchange(descriptor_, -1);
  if (::close(closing) != 0 && errno != EINTR) fail(path_, errno);
}

}  // namespace cordon::detail
