// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are nearly as they should be.
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace campaign {

using Random = std::mt19937_64;

inline std::size_t below(Random& random, std::size_t count) {
  return std::uniform_int_distribution<std::size_t>(0, count > 0 ? count - 1 : 0)(random);
}

/// Where a word (a name, a number, a quoted text) or a single sign begins, and how long it is;
/// nothing of an empty text.
struct Span {
  std::size_t at = 0, length = 0;
};
inline Span token(Random& random, const std::string& text) {
  if (text.empty()) return {};
  std::size_t at = below(random, text.size());
  const auto is_word = [&](std::size_t i) {
    const auto c = static_cast<unsigned char>(text[i]);
    return std::isalnum(c) || c == '.' || c == '-' || c == '+' || c == '_' || c == '"' || c == '/';
  };
  if (!is_word(at)) return {at, 1};
  while (at > 0 && is_word(at - 1)) --at;
  std::size_t end = at;
  while (end < text.size() && is_word(end)) ++end;
  return {at, end - at};
}

/// A stretch of any bytes.
inline Span stretch(Random& random, const std::string& text, std::size_t longest) {
  const std::size_t at = below(random, text.size() + 1);
  return {at, std::min(below(random, longest + 1), text.size() - at)};
}

inline std::string repeated(std::string_view text, std::size_t count) {
  std::string out;
  for (std::size_t i = 0; i < count; ++i) out += text;
  return out;
}

inline std::string hostile_word(Random& random) {
  static const std::vector<std::string> words{"1e308",
                                              "-1e308",
                                              "1e-320",
                                              "1e999",
                                              "-1e999",
                                              "9007199254740993",
                                              "99999999999999999999",
                                              "-0",
                                              "NaN",
                                              "Infinity",
                                              "-inf",
                                              "\"inf\"",
                                              "\"-inf\"",
                                              "\"nan\"",
                                              "0x10",
                                              "1e",
                                              ".5",
                                              "00012",
                                              "1e5",
                                              "4294967296",
                                              "-9223372036854775808",
                                              "2.5",
                                              "null",
                                              "true",
                                              "[]",
                                              "{}",
                                              "[[]]",
                                              "\"\"",
                                              "\"\\u0000\"",
                                              "\"\\ud800\"",
                                              "\"../../x\"",
                                              "\"=1+1\"",
                                              "\"\\u202e\"",
                                              "\"type\"",
                                              "\"box\"",
                                              "\"space\"",
                                              "\xff",
                                              "\r",
                                              "\"",
                                              "{",
                                              "]"};
  return words[below(random, words.size())];
}

inline std::string deeply_nested(Random& random) {
  const std::size_t depth = std::array<std::size_t, 4>{10, 63, 1000, 100'000}[below(random, 4)];
  const bool objects = below(random, 2) == 0, closed = below(random, 2) == 0;
  return repeated(objects ? "{\"a\":" : "[", depth) + "1" +
         (closed ? repeated(objects ? "}" : "]", depth) : "");
}

inline std::string very_long(Random& random) {
  const std::size_t length = std::array<std::size_t, 3>{300, 70'000, 2'000'000}[below(random, 3)];
  return below(random, 2) == 0 ? "\"" + std::string(length, 'x') + "\"" : std::string(length, '9');
}

/// Another number in the place of one, so that the file keeps its form; nothing if none is found.
inline void mutate_number(Random& random, std::string& text) {
  static const std::vector<std::string> numbers{
      "0",    "-0",    "1",     "-1",  "2",      "3",      "0.1",        "-2.5",
      "1e-9", "1e9",   "1e15",  "1e5", "-1e300", "1e308",  "-1e308",     "5e-324",
      "1e20", "1e-20", "1e150", "64",  "1000",   "100000", "4294967296", "9007199254740993"};
  for (int trial = 0; trial < 50; ++trial) {
    const Span word = token(random, text);
    if (word.length == 0 ||
        !(std::isdigit(static_cast<unsigned char>(text[word.at])) || text[word.at] == '-'))
      continue;
    text.replace(word.at, word.length, numbers[below(random, numbers.size())]);
    return;
  }
}

/// One change.
inline void mutate(Random& random, std::string& text) {
  const Span word = token(random, text), part = stretch(random, text, 200);
  switch (below(random, 14)) {
    case 0:
    case 1:
      if (!text.empty())
        text[below(random, text.size())] ^= static_cast<char>(1 << below(random, 8));
      break;
    case 2:
      text.resize(below(random, text.size() + 1));
      break;
    case 3: {  // two words change their places
      const std::string one = text.substr(word.at, word.length);
      const Span other = token(random, text);
      const std::string two = text.substr(other.at, other.length);
      const Span &first = word.at < other.at ? word : other,
                 &last = word.at < other.at ? other : word;
      text.replace(last.at, last.length, word.at < other.at ? one : two);
      text.replace(first.at, first.length, word.at < other.at ? two : one);
      break;
    }
    case 4:
    case 5:
    case 6:
      text.replace(word.at, word.length, hostile_word(random));
      break;
    case 7:
      text.erase(part.at, part.length);
      break;
    case 8:  // keys and rows come twice
      text.insert(part.at, text.substr(part.at, part.length));
      break;
    case 9: {
      const std::size_t end = text.find('\n', part.at),
                        begin = end == std::string::npos ? 0 : text.rfind('\n', part.at);
      const std::size_t from = begin == std::string::npos ? 0 : begin;
      const std::string line = text.substr(from, end == std::string::npos ? 200 : end - from);
      text.insert(from, line);
      break;
    }
    case 10:
      text.replace(word.at, word.length, very_long(random));
      break;
    case 11:
      text.replace(word.at, word.length, deeply_nested(random));
      break;
    case 12:
      for (std::size_t i = below(random, 20); i-- > 0;)
        text.insert(part.at, 1, static_cast<char>(below(random, 256)));
      break;
    default: {  // what stands elsewhere in the file
      const Span from = stretch(random, text, 100);
      text.insert(part.at, text.substr(from.at, from.length));
    }
  }
}

inline std::string mutated(Random& random, std::string text) {
  const bool keeps_form = below(random, 2) == 0;
  for (std::size_t changes = 1 + below(random, 3); changes-- > 0;)
    keeps_form ? mutate_number(random, text) : mutate(random, text);
  return text;
}

}  // namespace campaign
