// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded data.
#include "study/reading/read_parts.hpp"

namespace cordon::json {

namespace {

std::vector<std::string> read_columns(const Cursor& csv, const char* key, std::optional<Index> size,
                                      const std::string& like, bool needed) {
  const bool absent = !csv.find(key);
  if (absent && (!needed || size == Index{0})) return {};
  const auto at = csv.need(key, "a list of column names");
  if (!at) return {};
  auto names = read_names(*at, "column");
  if (names && size && static_cast<Index>(names->size()) != *size) {
    at->error("names " + counted(static_cast<Index>(names->size()), "column") + ", must name " +
              std::to_string(*size) + " like " + like);
  }
  return names.value_or(std::vector<std::string>{});
}

/// "time" and "irregular".
void read_time_column(const Cursor& at, const Labels& labels, CsvSpec& spec) {
  const auto time = at.find("time"), irregular = at.find("irregular");
  if (time) {
    spec.time = read_text(*time, 4096).value_or("");
    if (!(labels.sampling_time > 0)) {
      time->error("is a column of times, and /system has no \"sampling_time\"",
                  "give the seconds from k to k + 1 there");
    }
  }
  if (!irregular) return;
  if (!time)
    irregular->error("says what times are that leave steps out", "name the column \"time\"");
  const auto name = read_choice(*irregular, irregular_rows_names());
  if (name == "gaps") spec.irregular = IrregularRows::gaps;
  if (const auto truth = at.find("truth"); truth && name == "gaps") {
    truth->error("is not known at steps that the rows leave out",
                 "leave it out, or add rows for these steps");
  }
}

}  // namespace

const std::vector<std::string>& missing_value_names() {
  static const std::vector<std::string> names{"error", "skip"};
  return names;
}

const std::vector<std::string>& irregular_rows_names() {
  static const std::vector<std::string> names{"error", "gaps"};
  return names;
}

DataPart read_csv(const Cursor& at, const SystemPart& system, const std::filesystem::path& folder) {
  const Sizes& sizes = system.sizes;
  DataPart part;
  CsvSpec spec;
  if (!at.expect_keys(
          {"file", "inputs", "outputs", "truth", "mode", "missing", "time", "irregular"},
          "key of recorded data", "{\"file\": \"data.csv\", \"outputs\": [\"y\"]}"))
    return part;
  const auto file_at = at.need("file", "the CSV file, relative to the folder of the study");
  if (const auto file = file_at ? read_text(*file_at, 4096) : std::nullopt) {
    part.written_file = *file;
    spec.file = folder / *file;  // an absolute path replaces the folder
    std::error_code failure;
    const auto status = std::filesystem::status(spec.file, failure);
    if (!std::filesystem::exists(status)) {
      file_at->error("no such file: " + in_quotes(spec.file.string(), 1000),
                     "the path is relative to the folder of the study");
    } else if (std::filesystem::is_directory(status)) {
      file_at->error("is a directory: " + in_quotes(spec.file.string(), 1000),
                     "name the CSV file inside it");
    }
  }
  spec.inputs = read_columns(at, "inputs", sizes.inputs, system.inputs_at(), true);
  spec.outputs = read_columns(at, "outputs", sizes.outputs, system.outputs_at(), true);
  spec.truth = read_columns(at, "truth", sizes.states, system.states_at(), false);
  if (const auto mode = at.find("mode")) spec.mode = read_text(*mode, 4096).value_or("");
  if (const auto missing = at.find("missing")) {
    const auto name = read_choice(*missing, missing_value_names());
    spec.missing = name == "skip" ? MissingValue::skip : MissingValue::error;
  }
  read_time_column(at, system.labels, spec);
  part.data = std::move(spec);
  return part;
}

}  // namespace cordon::json
