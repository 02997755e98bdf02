// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as text, in both directions, independent of the locale.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace cordon::detail {

/// The shortest decimal text that reads back as the same double; "inf", "-inf", "nan".
std::string to_text(double value);

/// A finite decimal number, or the reason why `text` is none. Surrounding blanks and one leading
/// '+' are allowed.
struct ParsedNumber {
  double value = 0;
  std::string problem;  ///< empty: `value` holds
};
ParsedNumber parse_number(std::string_view text);

}  // namespace cordon::detail
