// SPDX-License-Identifier: GPL-3.0-or-later
// MATLAB keeps texts in UTF-16.
#pragma once

#include <string>
#include <string_view>

namespace cordon::mat {

/// Of well-formed UTF-8; other bytes become U+FFFD.
std::u16string to_utf16(std::string_view utf8);
/// Halves of a pair that stand alone become U+FFFD.
std::string to_utf8(std::u16string_view utf16);

}  // namespace cordon::mat
