// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_pipe.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <poll.h>
#include <unistd.h>

#include <climits>
#include <fmt/format.h>

#include "cordon/core/error.hpp"

namespace cordon::apps {

namespace {

constexpr int look_at_signals_ms = 200;
constexpr std::chrono::seconds for_line_at_hand{2};

[[noreturn]] void fail(const char* what) {
  throw Error(Errc::io, fmt::format("{}: {}", what, std::strerror(errno)));
}

/// Waits until the descriptor is ready. False: the signal came, and some time has passed since.
bool wait_for(int descriptor, short events, const std::atomic<bool>& stop,
              std::chrono::milliseconds after_signal, const std::function<void()>& idle = {}) {
  using Clock = std::chrono::steady_clock;
  std::optional<Clock::time_point> end;
  for (;;) {
    if (stop && !end) end = Clock::now() + after_signal;
    const bool is_last = end && Clock::now() >= *end;
    pollfd one{descriptor, events, 0};
    const int ready = ::poll(&one, 1, is_last ? 0 : look_at_signals_ms);
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) fail("waiting for data");
    if (is_last) return false;
    if (idle) idle();
  }
}

}  // namespace

bool LineInput::fill() {
  if (ended_ || *stop_ || !wait_for(descriptor_, POLLIN, *stop_, {}, idle_) || *stop_) return false;
  buffer_.erase(0, at_);
  at_ = 0;
  std::array<char, 1 << 16> piece;
  ssize_t count = 0;
  do {
    count = ::read(descriptor_, piece.data(), piece.size());
  } while (count < 0 && errno == EINTR && !*stop_);
  if (count < 0 && *stop_) return false;
  if (count < 0) fail("standard input cannot be read");
  ended_ = count == 0;
  buffer_.append(piece.data(), static_cast<std::size_t>(count));
  return true;
}

bool LineInput::next(std::string& line) {
  if (*stop_) return false;
  bool too_long = false;
  line.clear();
  for (;;) {
    const std::size_t end = buffer_.find('\n', at_);
    const std::size_t stop_at = end == std::string::npos ? buffer_.size() : end;
    if (!too_long) line.append(buffer_, at_, stop_at - at_);
    if (line.size() > most_bytes) {
      line.resize(most_bytes + 1);
      too_long = true;
    }
    if (end != std::string::npos) {
      at_ = end + 1;
      whole_ = true;
      return true;
    }
    at_ = buffer_.size();
    whole_ = false;
    if (ended_ || !fill()) return !line.empty() && !*stop_;
  }
}

bool LineOutput::write(std::string_view line) {
  while (!line.empty()) {
    if (!wait_for(descriptor_, POLLOUT, *stop_, for_line_at_hand)) return false;
    // No more than a pipe that is ready takes without waiting.
    const std::size_t piece = std::min<std::size_t>(line.size(), PIPE_BUF);
    const ssize_t count = ::write(descriptor_, line.data(), piece);
    if (count < 0 && errno == EPIPE) return false;
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count < 0) fail("cannot write to standard output");
    line.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace cordon::apps
