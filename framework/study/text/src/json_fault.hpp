// SPDX-License-Identifier: GPL-3.0-or-later
// Why a text is no JSON, in words that help whoever wrote it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace cordon::json {

/// What came last before a text stopped being JSON; it says what may come next.
enum class Last {
  nothing,        ///< the root comes next
  root,           ///< nothing comes next
  opened_array,   ///< an element, or "]"
  opened_object,  ///< a key, or "}"
  key,            ///< a colon and a value
  element,        ///< "," and an element, or "]"
  member,         ///< "," and a key, or "}"
};

struct Fault {
  /// Which value it is about: the list or object around, its latest part, or the part that begins.
  enum class Of { container, latest, next };

  std::size_t position = 0;  ///< of the byte
  std::string message, suggestion;
  Of of = Of::latest;
};

/// The first fault of `text` at or behind `at`, where what came last ends; `key` is the latest one.
/// To be asked about a text that the parser refused there: it finds words and accepts nothing. Its
/// text is UTF-8.
Fault fault_of(std::string_view text, std::size_t at, Last last, std::string_view key);

inline bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }
inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
/// The letters and underscores from `at` on.
std::string_view word_at(std::string_view text, std::size_t at);

}  // namespace cordon::json
