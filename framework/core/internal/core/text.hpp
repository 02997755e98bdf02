// SPDX-License-Identifier: GPL-3.0-or-later
// Texts of others, shown to people and written into tables.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace cordon::detail {

/// Length of the well-formed UTF-8 sequence (RFC 3629) at the front of `text`, 0 if there is none.
std::size_t utf8_length(std::string_view text);

/// A text that does to a terminal or a page what it looks like: control characters (C0, DEL, C1)
/// and those that change the direction of writing (U+061C, U+200E, U+200F, U+202A … U+202E, U+2066
/// … U+2069) as \uXXXX, bytes that are no UTF-8 as \xXX. Applied twice it is the same. Lines stay
/// lines only in `printable_lines`.
std::string printable(std::string_view text);
std::string printable_lines(std::string_view text);

/// A text that a spreadsheet would run as a formula (it begins with =, +, -, @ or a control
/// character, and is no number), with an apostrophe in front; others as they are.
std::string no_formula(const std::string& text);

/// A text as a field of a CSV file (RFC 4180), which no spreadsheet runs.
std::string csv_field(const std::string& text);

}  // namespace cordon::detail
