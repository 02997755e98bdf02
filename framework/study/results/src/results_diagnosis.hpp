// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace cordon::detail {

/// Columns of summary.csv that tell of diagnosers, in studies that have some.
const std::vector<std::string>& diagnosis_summary_columns();

}  // namespace cordon::detail
