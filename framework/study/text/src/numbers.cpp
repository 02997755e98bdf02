// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/numbers.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace cordon::detail {

namespace {

/// Text of a file for a message: shortened, control characters and foreign bytes replaced.
std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text.substr(0, 40)) out += (c >= ' ' && c < 0x7f) ? c : '?';
  return out + (text.size() > 40 ? "…\"" : "\"");
}

/// What is foreign in a text that would be a number otherwise; empty: nothing that is known.
std::string foreign_sign(std::string_view text) {
  constexpr std::string_view minus = "\xE2\x88\x92";  // U+2212
  std::string plain(text);
  std::string found;
  if (plain.starts_with(minus)) {
    plain.replace(0, minus.size(), "-");
    found = ", its minus is the sign U+2212: write \"-\"";
  }
  if (const std::size_t comma = plain.find(','); comma != std::string::npos) {
    plain[comma] = '.';
    found += ", decimals are separated by a point";
  }
  if (found.empty()) return "";
  double value = 0;
  const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  return error == std::errc{} && end == plain.data() + plain.size() ? found : "";
}

}  // namespace

std::string to_text(double value) {
  std::array<char, 40> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return std::string(buffer.data(), end);
}

ParsedNumber parse_number(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  if (text.empty()) return {0, "is empty"};
  std::string_view digits = text;
  if (digits.front() == '+' && digits.size() > 1 && digits[1] != '-') digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range)
    return {0, quoted(text) + " is beyond the range of a double"};
  if (error != std::errc{} || end != digits.data() + digits.size())
    return {0, quoted(text) + " is not a number" + foreign_sign(text)};
  if (!std::isfinite(value)) return {0, quoted(text) + " is not finite"};
  return {value, ""};
}

}  // namespace cordon::detail
