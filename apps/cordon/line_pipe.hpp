// SPDX-License-Identifier: GPL-3.0-or-later
// Lines through standard input and output, one at a time, while a signal may ask to end.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace cordon::apps {

/// Reads lines from a file descriptor, as soon as they are whole.
class LineInput {
 public:
  /// Of a longer line the beginning is told, one byte more than this, and the rest is passed over.
  static constexpr std::size_t most_bytes = std::size_t{1} << 20;

  /// `idle` is called while no line comes, some times a second.
  LineInput(int descriptor, const std::atomic<bool>* stop, std::function<void()> idle = {})
      : descriptor_(descriptor), stop_(stop), idle_(std::move(idle)) {}

  /// The next line without its end; the last one may lack it. False: there is none, or the signal
  /// came. Throws Errc::io.
  bool next(std::string& line);
  /// Had the last one its end? It may be cut off otherwise.
  bool was_whole() const { return whole_; }
  /// Is a whole line waiting, so that `next` would not?
  bool has_line() const { return buffer_.find('\n', at_) != std::string::npos; }

 private:
  bool fill();

  int descriptor_;
  const std::atomic<bool>* stop_;
  std::function<void()> idle_;
  std::string buffer_;
  std::size_t at_ = 0;
  bool ended_ = false, whole_ = false;
};

/// Writes lines to a file descriptor, each at once.
class LineOutput {
 public:
  LineOutput(int descriptor, const std::atomic<bool>* stop)
      : descriptor_(descriptor), stop_(stop) {}

  /// Waits while nobody reads. False: the reader has gone, or the signal came, and for two seconds
  /// more nobody has read. Throws Errc::io.
  bool write(std::string_view line);

 private:
  int descriptor_;
  const std::atomic<bool>* stop_;
};

}  // namespace cordon::apps
