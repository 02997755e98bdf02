// SPDX-License-Identifier: GPL-3.0-or-later
// What is known of the columns of a table: told by metrics, written into the results, or of the
// host's own numbers.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "cordon/study/result_table.hpp"
#include "study/text/json_cursor.hpp"
#include "study/text/json_writer.hpp"

namespace cordon::detail {

/// The member "measures" of an open object, if there are any; of each what differs from the
/// default.
void write_measures(JsonWriter& json, const std::vector<Measure>& measures);
/// Those of the object; none in results of earlier versions.
std::vector<Measure> read_measures(const json::Cursor& root);

/// Of the numbers that the host finds itself, in the order of tables.
std::span<const Measure> own_measures();

/// Of a column: also of those that have no measure, or one for many.
std::string title_of(const Measure* measure, std::string_view name);

/// The columns that a comparison shows, in their order: what metrics have told, what they have not,
/// then the host's own.
std::vector<std::size_t> compared_columns(const ResultTable& table);

}  // namespace cordon::detail
