// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/interchange/utf16.hpp"

#include <algorithm>
#include <cstdint>

#include "core/text.hpp"

namespace cordon::mat {

namespace {

void append_utf8(std::string& out, std::uint32_t point) {
  const auto tail = [&](int shift) { out += static_cast<char>(0x80 | ((point >> shift) & 0x3F)); };
  if (point < 0x80) {
    out += static_cast<char>(point);
  } else if (point < 0x800) {
    out += static_cast<char>(0xC0 | (point >> 6));
    tail(0);
  } else if (point < 0x10000) {
    out += static_cast<char>(0xE0 | (point >> 12));
    tail(6), tail(0);
  } else {
    out += static_cast<char>(0xF0 | (point >> 18));
    tail(12), tail(6), tail(0);
  }
}

/// The code point at the front, U+FFFD for bytes that are no UTF-8; removes it.
std::uint32_t take(std::string_view& utf8) {
  const std::size_t length = detail::utf8_length(utf8);
  const auto lead = static_cast<unsigned char>(utf8[0]);
  std::uint32_t point = length == 0 ? 0xFFFD : length == 1 ? lead : lead & (0x7Fu >> length);
  for (std::size_t i = 1; i < length; ++i)
    point = (point << 6) | (static_cast<unsigned char>(utf8[i]) & 0x3Fu);
  utf8.remove_prefix(std::max<std::size_t>(1, length));
  return point;
}

}  // namespace

std::u16string to_utf16(std::string_view utf8) {
  std::u16string out;
  while (!utf8.empty()) {
    const std::uint32_t point = take(utf8);
    if (point < 0x10000) {
      out += static_cast<char16_t>(point);
    } else {
      out += static_cast<char16_t>(0xD800 + ((point - 0x10000) >> 10));
      out += static_cast<char16_t>(0xDC00 + ((point - 0x10000) & 0x3FF));
    }
  }
  return out;
}

std::string to_utf8(std::u16string_view utf16) {
  std::string out;
  for (std::size_t i = 0; i < utf16.size(); ++i) {
    const std::uint32_t unit = utf16[i];
    const bool first = unit >= 0xD800 && unit < 0xDC00, second = unit >= 0xDC00 && unit < 0xE000;
    const std::uint32_t next = i + 1 < utf16.size() ? utf16[i + 1] : 0;
    if (first && next >= 0xDC00 && next < 0xE000) {
      append_utf8(out, 0x10000 + ((unit - 0xD800) << 10) + (next - 0xDC00));
      ++i;
    } else {
      append_utf8(out, first || second ? 0xFFFD : unit);
    }
  }
  return out;
}

}  // namespace cordon::mat
