// SPDX-License-Identifier: GPL-3.0-or-later
#include "stream_log.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include "common.hpp"
#include "cordon/core/error.hpp"
#include "file_lock.hpp"
#include "study/text/json_writer.hpp"
#include "study/text/publish.hpp"

namespace cordon::apps {

namespace {

constexpr std::string_view before_alarm = "{\"alarm\": ", before_lost = "{\"lost\": ";

std::string head_of(const std::string& pipeline) {
  return "{\"cordon_log\": 1, \"pipeline\": " + detail::json_string(pipeline) + "}";
}

/// Does it begin with this line, and does a line end where it is to be cut?
bool is_of(const std::filesystem::path& file, const std::string& head, std::int64_t keep) {
  std::ifstream in(file, std::ios::binary);
  std::string first;
  std::error_code failure;
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(file, failure));
  if (keep == 0 || failure || size < keep) return true;  // told elsewhere
  if (!std::getline(in, first) || first + "\n" != head) return false;
  char last = 0;
  return in.seekg(keep - 1) && in.get(last) && last == '\n';
}

}  // namespace

StreamLog::StreamLog(std::filesystem::path file, const std::string& pipeline, std::int64_t keep,
                     std::int64_t lost)
    : file_(std::move(file)), lost_(lost) {
  const std::string head = head_of(pipeline) + "\n";
  const auto refuse = [&](const char* what, const char* what_to_do) {
    throw InputError(file_.string(), {{"", what, what_to_do}});
  };
  if (detail::is_there(file_) && !std::filesystem::is_regular_file(file_))
    refuse("is no regular file, and cannot be cut where a stream goes on", "name a file");
  if (detail::is_there(file_) && !is_of(file_, head, keep))
    refuse("is not the log that the checkpoint was written with",
           "name the log that belongs to it");
  if (keep == 0 && detail::is_there(file_) && std::filesystem::file_size(file_) > head.size())
    refuse("exists already",
           "name the checkpoint that belongs to it by \"--checkpoint\", or move it away to begin "
           "anew");
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0)
    throw Error(Errc::io, fmt::format("{}: {}", file_.string(), std::strerror(errno)));
  try {
    lock(descriptor_, file_);
    if (keep > 0 && ::lseek(descriptor_, 0, SEEK_END) < keep)
      refuse("is shorter than it was at the checkpoint", "name the log that belongs to it");
    cut_off(keep);
    if (keep == 0) append(head);
  } catch (const Error&) {
    ::close(descriptor_);
    throw;
  }
}

/// Of what is behind nothing is lost.
void StreamLog::cut_off(std::int64_t keep) {
  const std::int64_t behind = keep > 0 ? ::lseek(descriptor_, 0, SEEK_END) - keep : 0;
  if (behind > 0) {
    std::string text(static_cast<std::size_t>(behind), 0);
    const std::filesystem::path beside = file_.string() + ".cut";
    std::ofstream out(beside, std::ios::binary | std::ios::app);
    const bool is_kept = ::pread(descriptor_, text.data(), text.size(), keep) == behind &&
                         out.write(text.data(), behind).flush();
    if (!is_kept) throw Error(Errc::io, beside.string() + ": cannot be written");
    cut_ = behind;
  }
  if (::ftruncate(descriptor_, keep) != 0)
    throw Error(Errc::io, fmt::format("{}: {}", file_.string(), std::strerror(errno)));
  bytes_ = keep;
}

StreamLog::~StreamLog() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void StreamLog::write(const std::string& line) {
  ++lost_;  // unless it is written
  if (lost_ > 1) append(std::string(before_lost) + std::to_string(lost_ - 1) + "}\n");
  lost_ = std::min<std::int64_t>(lost_, 1);
  append(line);
  lost_ = 0;
}

void StreamLog::append(const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = ::write(descriptor_, text.data() + done, text.size() - done);
    if (count >= 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      const int reason = errno;
      [[maybe_unused]] const int cut = ::ftruncate(descriptor_, bytes_);
      throw Error(Errc::io, fmt::format("{}: {}", file_.string(), std::strerror(reason)));
    }
  }
  bytes_ += static_cast<std::int64_t>(text.size());
}

void StreamLog::flush() {
  struct stat held {
  }, named{};
  if (::fstat(descriptor_, &held) != 0 || ::stat(file_.c_str(), &named) != 0 ||
      held.st_ino != named.st_ino || held.st_dev != named.st_dev)
    throw Error(Errc::io, file_.string() + ": was moved away or removed");
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL)
    throw Error(Errc::io, fmt::format("{}: {}", file_.string(), std::strerror(errno)));
}

bool ReplayedLog::is_alarm(const std::string& line) { return line.starts_with(before_alarm); }

std::string ReplayedLog::alarm_in(const std::string& line) {
  return line.substr(before_alarm.size(), line.size() - before_alarm.size() - 1);
}

ReplayedLog::ReplayedLog(const std::filesystem::path& file, const std::string& pipeline) {
  std::string first;
  if (!detail::is_there(file))
    throw InputError(file.string(), {{"", "there is no such file", "name a log"}});
  if (std::filesystem::is_regular_file(file)) stream_.open(file, std::ios::binary);
  if (!stream_.is_open() || !std::getline(stream_, first) ||
      !first.starts_with("{\"cordon_log\": 1, "))
    throw InputError(file.string(),
                     {{"", "is no log of a stream", "name a file that \"--log\" has written"}});
  if (first != head_of(pipeline))
    throw InputError(file.string(), {{"", "is the log of another pipeline: " + first,
                                      "name that pipeline by \"--pipeline\""}});
}

bool ReplayedLog::read(std::string& line) {
  if (lacks_lines_ || !std::getline(stream_, line)) return false;
  torn_ = stream_.eof();
  lacks_lines_ = !torn_ && line.starts_with(before_lost);
  return !torn_ && !lacks_lines_;
}

bool ReplayedLog::next(std::string& line) {
  while (read(line)) {
    if (!is_alarm(line)) return true;
    expected_.push_back(alarm_in(line));
  }
  return false;
}

void ReplayedLog::compare(const std::string& alarm) {
  // Those of a sample stand behind it in the log.
  std::string line;
  bool has_ended = false;
  while (at_ >= expected_.size()) {
    const auto place = stream_.tellg();
    has_ended = !read(line);
    if (has_ended) break;
    if (!is_alarm(line)) {
      stream_.seekg(place);
      break;
    }
    expected_.push_back(alarm_in(line));
  }
  if (has_ended) {
    ++cut_off_;
    return;
  }
  const bool is_expected = at_ < expected_.size();
  if (is_expected && expected_[at_] == alarm) {
    ++agreed_;
  } else {
    ++others_;
    if (first_difference_.empty()) first_difference_ = alarm;
  }
  if (is_expected) ++at_;
}

std::vector<std::string> ReplayedLog::differences() const {
  std::vector<std::string> found;
  if (others_ > 0)
    found.push_back(fmt::format("{} {} not as in the log; the first: {}",
                                count(others_, "alarm change"), others_ == 1 ? "is" : "are",
                                first_difference_));
  if (at_ < expected_.size())
    found.push_back(
        fmt::format("{} alarm changes of the log have not come again", expected_.size() - at_));
  return found;
}

}  // namespace cordon::apps
