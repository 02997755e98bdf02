// SPDX-License-Identifier: GPL-3.0-or-later
// A comparison table as LaTeX, ready to paste.
#pragma once

#include <string>

#include "cordon/study/comparison_table.hpp"
#include "study/text/sink.hpp"

namespace cordon::detail {

/// A table with booktabs, shrunk to the width of the text where it is wider.
void write_latex(Sink& file, const std::string& title, const ComparisonTable& table);

}  // namespace cordon::detail
