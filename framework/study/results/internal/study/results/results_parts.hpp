// SPDX-License-Identifier: GPL-3.0-or-later
// How the files of a run write single values.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cordon/core/answer.hpp"
#include "cordon/core/box.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/study/result_table.hpp"
#include "cordon/study/run.hpp"
#include "core/text.hpp"
#include "study/text/json_writer.hpp"

namespace cordon::detail {

std::string csv_number(double value);  ///< NaN: empty
std::string csv_time(std::int64_t k);  ///< a time index that may not exist: negative ones are empty
std::string joined(const std::vector<std::string>& fields);  ///< one row with its line end

void write_time(JsonWriter& json, std::string_view name, std::int64_t k);  ///< negative: null
/// "NAME_from", and where it has happened "NAME_proven": has the host proven it?
void write_claim(JsonWriter& json, const std::string& name, std::int64_t from, bool proven);
void write_blocks(JsonWriter& json,
                  const LineForm& X);  ///< the members of an exchange form, inside an open object
void write_box(JsonWriter& json, std::string_view key, const Box& box);  ///< {lower, upper}
/// "numbers": {name: number} of those that are measured, or of the others; NaN is left out.
void write_numbers(JsonWriter& json, const std::vector<ResultNumber>& numbers, bool measured);
/// "assumptions_until" and "failed_assumption".
void write_assumptions(JsonWriter& json, const PipelineOutcome& outcome,
                       const std::vector<std::string>& modes);
void write_error(JsonWriter& json, const PipelineOutcome& outcome);  ///< "error"; none: null
std::vector<std::string> mode_names(const Study& study);             ///< in the order of the bank
void write(JsonWriter& json, const LineForm& X);
void write(JsonWriter& json, const Certificate& why);

}  // namespace cordon::detail
