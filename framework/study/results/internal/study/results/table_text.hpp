// SPDX-License-Identifier: GPL-3.0-or-later
// Names and values as they stand in tables: escaped for whoever reads the file.
#pragma once

#include <string>
#include <string_view>

#include "cordon/study/result_table.hpp"

namespace cordon::detail {

/// A value of an axis as people write it: texts without their quotes, everything else as JSON;
/// printable, and what is longer than `limit` bytes is cut.
std::string axis_value(const ResultTable& table, std::size_t axis, std::size_t index,
                       std::size_t limit = 32);

/// Text for LaTeX: special characters escaped, control characters as blanks. Other characters stay
/// as they are, in UTF-8.
std::string latex_text(std::string_view text);

/// Text for a cell of a Markdown table, without markup and HTML.
std::string markdown_text(std::string_view text);

}  // namespace cordon::detail
