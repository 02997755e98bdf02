// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded data of MATLAB as a CSV file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/interchange/mat_value.hpp"
#include "study/reading/read_parts.hpp"
#include "study/text/json_text.hpp"

namespace cordon::mat {

struct CsvData {
  std::string text;
  CsvSpec spec;  ///< the names of the columns
};

/// u, y, and x and mode where they are, of a struct; samples stand in columns or in rows. Nothing
/// if there is no y. Reports what is wrong at `pointer`.
std::optional<CsvData> data_of(const Value& data, const json::SystemPart& system,
                               const std::string& pointer, json::Problems& problems);

}  // namespace cordon::mat
