// SPDX-License-Identifier: GPL-3.0-or-later
// The text of a JSON file as the library's parser gets to read it, character by character.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "json_fault.hpp"

namespace cordon::json {

/// What each byte of a text is shown as to the library, inside of JSON's texts or outside.
using Shown = std::array<char, 256>;
constexpr Shown shown_bytes(bool in_text) {
  Shown table{};
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = static_cast<char>(i);
  table[0] = '\x01';
  for (std::size_t i = '1'; i <= '9' && !in_text; ++i) table[i] = '0';
  return table;
}
inline constexpr Shown outside = shown_bytes(false), inside = shown_bytes(true);

/// The library decides what is JSON. Of a text it is shown
/// - 0 in place of each run of digits outside of texts, and 00 of one that begins so: whether a
///   number is one depends on no more, and its value is taken from the text itself, so that neither
///   the locale nor the size of a number matters;
/// - one blank in place of several, and none behind a comma, a colon and an opening bracket;
/// - null in place of NaN, -Infinity and the like, so that the reading goes on behind them;
/// - U+0001, which is JSON nowhere, in place of NUL, which would pass for the end of the text;
/// - all else as it is.
class Source {
 public:
  explicit Source(std::string_view text)
      : begin_(text.data()), end_(begin_ + text.size()), at_(begin_), stop_(end_) {
    replace_infinite();
  }

  bool ended() const { return at_ == stop_; }
  char now() const { return (*shown_)[static_cast<unsigned char>(*at_)]; }
  void advance();
  /// Behind the text or word that was read last.
  std::size_t position() const { return static_cast<std::size_t>(at_ - begin_); }
  /// The word that the null stands for that was read last; empty if it is one. Forgets it.
  std::string_view take_infinite() {
    const std::string_view word = infinite_;
    infinite_ = {};
    return word;
  }

 private:
  void replace_infinite();
  bool is_escaped() const;

  const char *begin_, *end_;
  const char *at_, *stop_;         ///< what is shown: the text, or the null in place of a word
  const char* resumed_ = nullptr;  ///< behind which the text goes on here; nullptr in the text
  const Shown* shown_ = &outside;
  std::string_view infinite_;
};

inline void Source::advance() {
  const char c = *at_++;
  if (shown_ == &inside) {
    if (c == '"' && !is_escaped()) shown_ = &outside;
    return;
  }
  if (resumed_) {
    if (at_ == stop_) {
      at_ = resumed_;
      stop_ = end_;
      resumed_ = nullptr;
    }
    return;
  }
  if (is_digit(c)) {
    if (c != '0' || (at_ - begin_ > 1 && is_digit(at_[-2])))
      while (at_ != end_ && is_digit(*at_)) ++at_;
  } else if (c == '"') {
    shown_ = &inside;
  } else if (c == ',' || c == ':' || c == '[' || c == '{' || is_space(c)) {
    while (at_ != end_ && is_space(*at_)) ++at_;
    replace_infinite();
  }
}

/// The quote that was read last, of a text.
inline bool Source::is_escaped() const {
  const char* backslash = at_ - 1;
  while (backslash[-1] == '\\') --backslash;
  return (at_ - backslash) % 2 == 0;
}

inline void Source::replace_infinite() {
  const char* first = at_;
  if (first != end_ && *first == '-') ++first;
  if (first == end_ || (*first | 0x20) < 'i' || (*first | 0x20) > 'n') return;
  static constexpr std::string_view null = "null";
  static constexpr std::array<std::string_view, 8> words{"NaN",      "nan", "NAN", "Infinity",
                                                         "infinity", "inf", "Inf", "INF"};
  const std::string_view word = word_at({first, end_}, 0);
  if (std::find(words.begin(), words.end(), word) == words.end()) return;
  infinite_ = word;
  resumed_ = word.data() + word.size();
  at_ = null.data();
  stop_ = at_ + null.size();
}

}  // namespace cordon::json
