// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/input_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include "cordon/core/error.hpp"

namespace cordon::detail {

namespace {

constexpr std::size_t chunk = std::size_t{1} << 16;

/// What is no regular file, in words; nullptr for one.
const char* kind_of(mode_t mode) {
  if (S_ISREG(mode)) return nullptr;
  if (S_ISDIR(mode)) return "is a directory, not a regular file";
  if (S_ISFIFO(mode)) return "is a pipe, not a regular file";
  if (S_ISSOCK(mode)) return "is a socket, not a regular file";
  return "is a device, not a regular file";
}

}  // namespace

InputFile::InputFile(std::filesystem::path path, std::string suggestion) : path_(std::move(path)) {
  struct stat status;
  // Looked at before it is opened: opening a device can do something. And again after: it may be
  // another one by then.
  const char* kind = ::stat(path_.c_str(), &status) == 0 ? kind_of(status.st_mode) : nullptr;
  if (!kind) {
    descriptor_ = ::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (descriptor_ < 0 && errno == ENOTDIR)
      refuse("there is no such file: " + path_.parent_path().string() + " is no directory",
             "name a directory that \"cordon run\" wrote");
    if (descriptor_ < 0) {
      refuse(errno == ENOENT ? "there is no such file"
                             : std::string("cannot be read: ") + std::strerror(errno),
             suggestion);
    }
    if (::fstat(descriptor_, &status) == 0) kind = kind_of(status.st_mode);
  }
  if (!kind) return;
  if (descriptor_ >= 0) ::close(descriptor_);
  refuse(kind, suggestion);
}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

InputFile::InputFile(InputFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      buffer_(std::move(other.buffer_)),
      at_(other.at_),
      lines_(other.lines_),
      ended_(other.ended_) {}

std::size_t InputFile::read(char* to, std::size_t most) {
  std::size_t got = 0;
  while (got < most) {
    const ssize_t now = ::read(descriptor_, to + got, most - got);
    if (now < 0 && errno == EINTR) continue;
    if (now < 0)
      refuse(std::string("cannot be read to its end: ") + std::strerror(errno),
             "check the file system");
    if (now == 0) break;
    got += static_cast<std::size_t>(now);
  }
  return got;
}

bool InputFile::fill() {
  buffer_.resize(chunk);
  buffer_.resize(read(buffer_.data(), chunk));
  at_ = 0;
  return !buffer_.empty();
}

bool InputFile::line(std::string& text, std::size_t longest) {
  text.clear();
  if (at_ == buffer_.size() && !fill()) return false;
  ++lines_;
  ended_ = false;
  do {
    const std::size_t end = buffer_.find('\n', at_), stop = std::min(end, buffer_.size());
    if (text.size() + (stop - at_) > longest)
      refuse("a line is longer than " + std::to_string(longest) + " bytes", "", lines_);
    text.append(buffer_, at_, stop - at_);
    ended_ = end != std::string::npos;
    at_ = stop + (ended_ ? 1 : 0);
  } while (!ended_ && fill());
  return true;
}

std::string InputFile::rest(std::size_t most, const std::string& suggestion) {
  std::string text = buffer_.substr(at_);
  buffer_.clear();
  at_ = 0;
  for (std::size_t before = text.size();; before = text.size()) {
    text.resize(before + chunk);
    text.resize(before + read(text.data() + before, chunk));
    if (text.size() > most)
      refuse("is larger than " + std::to_string(most >> 20) + " MB", suggestion);
    if (text.size() < before + chunk) return text;
  }
}

void InputFile::refuse(const std::string& reason, const std::string& suggestion,
                       std::int64_t line) const {
  throw InputError(
      path_.string(),
      {{"", reason, suggestion, static_cast<int>(std::min<std::int64_t>(line, 1'000'000'000))}});
}

}  // namespace cordon::detail
