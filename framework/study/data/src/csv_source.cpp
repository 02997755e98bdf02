// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/data/csv_source.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <set>

#include "core/text.hpp"
#include "study/text/json_text.hpp"
#include "study/text/numbers.hpp"

namespace cordon::detail {

namespace {

constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// An empty field, or NaN in any case of letters.
bool is_missing(const std::string& field) {
  std::string text = trimmed(field);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(c < 128 ? std::tolower(c) : c); });
  return text.empty() || text == "nan";
}

bool is_utf8(std::string_view text) {
  for (std::size_t length = 0; !text.empty(); text.remove_prefix(length)) {
    length = utf8_length(text);
    if (length == 0) return false;
  }
  return true;
}

void require_file(const std::filesystem::path& file) {
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  const auto fail = [&](const std::string& why) {
    throw InputError(file.string(),
                     {{"/data/csv/file", why, "the path is relative to the folder of the study"}});
  };
  if (status.type() == std::filesystem::file_type::not_found) fail("there is no such file");
  if (status.type() == std::filesystem::file_type::directory)
    fail("is a directory, not a CSV file");
  if (status.type() != std::filesystem::file_type::regular)
    fail("is not a regular file (it is read twice)");
}

}  // namespace

CsvSource::CsvSource(const CsvSpec& spec, const Model& model, std::vector<std::string> modes,
                     double sampling_time)
    : file_(spec.file),
      inputs_{spec.inputs, {}, "/data/csv/inputs"},
      outputs_{spec.outputs, {}, "/data/csv/outputs"},
      truth_{spec.truth, {}, "/data/csv/truth"},
      mode_{{}, {}, "/data/csv/mode"},
      time_{{}, {}, "/data/csv/time"},
      skips_missing_(spec.missing == MissingValue::skip),
      modes_(std::move(modes)),
      sampling_time_(sampling_time),
      fills_(spec.irregular == IrregularRows::gaps),
      clock_(sampling_time, fills_) {
  if (!spec.mode.empty()) mode_.names.push_back(spec.mode);
  if (!spec.time.empty()) time_.names.push_back(spec.time);
  check_sizes(spec, model);
  require_file(file_);
  validate();
  if (!problems_.empty()) {
    if (too_many())
      problems_.back().suggestion +=
          std::string(problems_.back().suggestion.empty() ? "" : "; ") + "reading stopped here";
    throw InputError(file_.string(), std::move(problems_));
  }
  reader_.emplace(file_);
  CsvRow header;
  reader_->next(header);
}

void CsvSource::check_sizes(const CsvSpec& spec, const Model& model) const {
  std::vector<Diagnostic> problems;
  const auto require = [&](std::size_t size, Index wanted, const char* pointer, const char* of) {
    if (static_cast<Index>(size) == wanted) return;
    problems.push_back({pointer,
                        "names " + std::to_string(size) + " columns, must be " +
                            std::to_string(wanted) + ", " + of,
                        ""});
  };
  require(spec.inputs.size(), model.inputs(), "/data/csv/inputs", "one per column of /system/B");
  require(spec.outputs.size(), model.outputs(), "/data/csv/outputs", "one per row of /system/C");
  if (!spec.truth.empty())
    require(spec.truth.size(), model.states(), "/data/csv/truth", "one per state");
  if (!problems.empty()) throw InputError(file_.string(), std::move(problems));
}

void CsvSource::report(std::string pointer, std::int64_t line, std::string message,
                       std::string suggestion) {
  if (too_many()) return;
  problems_.push_back({std::move(pointer), std::move(message), std::move(suggestion),
                       static_cast<int>(std::min<std::int64_t>(line, 2147483647))});
}

void CsvSource::validate() {
  CsvReader reader(file_);
  CsvRow row;
  if (!reader.next(row)) {
    report("/data/csv/file", 0, "the file is empty",
           "it needs a header row with the names of its columns, and rows of numbers");
    return;
  }
  if (!row.problem.empty()) {
    report("/data/csv/file", row.line, "header row: " + row.problem);
    return;
  }
  if (!locate(row)) return;
  StepClock clock(sampling_time_, fills_);
  while (!too_many() && reader.next(row)) {
    check_row(row);
    if (row.problem.empty() && row.fields.size() == width_)
      steps_ = step(row, clock).value_or(steps_) + 1;
    ++rows_;
  }
  if (rows_ == 0 && !too_many())
    report("/data/csv/file", 0, "there is a header but no row of numbers",
           "below the header it needs a row for every step");
}

bool CsvSource::locate(const CsvRow& row) {
  std::vector<std::string> header;
  for (const std::string& field : row.fields) header.push_back(trimmed(field));
  width_ = header.size();
  const std::string& first = header.front();
  if (first.starts_with("\xFF\xFE") || first.starts_with("\xFE\xFF")) {
    report("/data/csv/file", row.line, "the file is UTF-16", "save it as UTF-8");
    return false;
  }
  if (header.size() == 1 && first.find_first_of(";\t") != std::string::npos) {
    const bool semicolon = first.find(';') != std::string::npos;
    report(
        "/data/csv/file", row.line,
        std::string("the header seems to be separated by ") + (semicolon ? "semicolons" : "tabs"),
        "only commas separate columns, with a decimal point in numbers");
  }
  if (first.starts_with('#') || first.starts_with('%')) {
    report("/data/csv/file", row.line, "the first line is a comment, the header row must be first",
           "remove lines that begin with " + first.substr(0, 1));
    return false;
  }
  if (std::any_of(header.begin(), header.end(), [](const auto& name) { return !is_utf8(name); })) {
    report("/data/csv/file", row.line, "the header is not UTF-8 (it may be Latin-1)",
           "save the file as UTF-8");
    return false;
  }
  std::set<std::string> seen, told;
  for (const std::string& name : header) {
    if (name.empty() || seen.insert(name).second || !told.insert(name).second) continue;
    report("/data/csv/file", row.line,
           "the column " + json::in_quotes(name) + " appears more than once", "rename one of them");
  }
  for (Columns* columns : {&inputs_, &outputs_, &truth_, &mode_, &time_})
    find_columns(*columns, header);
  return true;
}

void CsvSource::find_columns(Columns& columns, const std::vector<std::string>& header) {
  for (std::size_t i = 0; i < columns.names.size(); ++i) {
    const auto place = std::find(header.begin(), header.end(), columns.names[i]);
    columns.at.push_back(place == header.end() ? nowhere
                                               : static_cast<std::size_t>(place - header.begin()));
    if (place != header.end()) continue;
    std::vector<std::string> candidates;
    for (const std::string& name : header) {
      if (candidates.size() < 30 && name.size() <= 60) candidates.push_back(name);
    }
    report(&columns == &mode_ || &columns == &time_ ? columns.pointer
                                                    : columns.pointer + "/" + std::to_string(i),
           1, "there is no column " + json::in_quotes(columns.names[i]) + " in the header",
           suggest(columns.names[i], candidates));
  }
}

void CsvSource::check_row(const CsvRow& row) {
  if (!row.problem.empty()) {
    report("/data/csv/file", row.line, row.problem);
  } else if (row.fields.size() != width_) {
    report("/data/csv/file", row.line,
           "the row has " + std::to_string(row.fields.size()) +
               (row.fields.size() == 1 ? " field" : " fields") + ", the header " +
               std::to_string(width_),
           row.fields.size() > width_
               ? "numbers with a decimal comma fall apart: write a point"
               : "each row has a field for each column, also where it is empty");
  } else {
    for (const Columns* columns : {&inputs_, &outputs_, &truth_}) numbers(row, *columns);
    mode(row);
  }
}

namespace {

/// What to do about a field that holds no number.
std::string suggestion_for(const std::string& field, bool is_output) {
  const bool is_word = field.find_first_of("0123456789") == std::string::npos;
  if (!is_output) return is_word ? "only outputs may be missing, every row needs this number" : "";
  return is_missing(field) ? "with \"missing\": \"skip\" in /data/csv, observers use the other "
                             "outputs of such samples"
                           : "where there is no value, leave the field empty, with \"missing\": "
                             "\"skip\" in /data/csv";
}

}  // namespace

/// The numbers of a group of columns; nothing after reporting what is wrong.
std::optional<Vector> CsvSource::numbers(const CsvRow& row, const Columns& columns) {
  Vector values(static_cast<Index>(columns.at.size()));
  bool good = true;
  for (std::size_t i = 0; i < columns.at.size(); ++i) {
    if (columns.at[i] == nowhere) continue;
    const std::string& field = row.fields[columns.at[i]];
    const bool is_output = &columns == &outputs_, is_gap = is_output && is_missing(field);
    if (is_gap && skips_missing_) {
      values[static_cast<Index>(i)] = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    const ParsedNumber number = parse_number(field);
    values[static_cast<Index>(i)] = number.value;
    if (number.problem.empty()) continue;
    good = false;
    report("/data/csv/file", row.line,
           "column " + json::in_quotes(columns.names[i]) + ": " + number.problem,
           suggestion_for(field, is_output));
  }
  return good ? std::optional<Vector>(std::move(values)) : std::nullopt;
}

/// The mode of a row, by its name or else its number in the bank, -1 for an empty field: outside
/// the bank; nothing if it is not recorded, or after reporting what is wrong.
std::optional<Index> CsvSource::mode(const CsvRow& row) {
  if (mode_.at.empty() || mode_.at.front() == nowhere) return std::nullopt;
  const std::string& field = row.fields[mode_.at.front()];
  const std::string name = trimmed(field);
  if (name.empty()) return -1;
  const auto found = std::find_if(modes_.begin(), modes_.end(), [&](const std::string& m) {
    return m == field || m == name || no_formula(m) == field;
  });
  if (found != modes_.end()) return static_cast<Index>(found - modes_.begin());
  for (Index index = -1; index < std::ssize(modes_); ++index) {
    if (name == std::to_string(index)) return index;  // as runs write it
  }
  report("/data/csv/file", row.line,
         "column " + json::in_quotes(mode_.names.front()) + ": there is no mode " +
             json::in_quotes(name),
         suggest(name.substr(0, 200), modes_));
  return std::nullopt;
}

/// The step that a row is of; nothing after reporting what is wrong.
std::optional<std::int64_t> CsvSource::step(const CsvRow& row, StepClock& clock) {
  if (time_.names.empty()) return &clock == &clock_ ? k_ : steps_;
  const std::optional<Vector> time = numbers(row, time_);
  if (!time || time_.at.front() == nowhere) return std::nullopt;
  StepClock::Answer answer = clock.step_at((*time)[0]);
  if (answer.problem.empty()) return answer.k;
  report("/data/csv/file", row.line,
         "column " + json::in_quotes(time_.names.front()) + ": " + answer.problem,
         std::move(answer.suggestion));
  return std::nullopt;
}

std::optional<Record> CsvSource::next() {
  std::optional<Record> record = waiting_ ? std::exchange(waiting_, std::nullopt) : next_row();
  if (!record) return std::nullopt;
  Sample& sample = record->sample;
  if (sample.k == k_) {
    last_input_ = sample.u;
    last_mode_ = record->mode;
    ++k_;
    return record;
  }
  const Index p = sample.y.size();
  Record gap{{static_cast<Index>(k_++), last_input_,
              Vector::Constant(p, std::numeric_limits<double>::quiet_NaN())},
             std::nullopt,
             last_mode_ == record->mode ? last_mode_ : std::nullopt};
  for (Index i = 0; i < p; ++i) gap.sample.missing.push_back(i);
  waiting_ = std::move(record);
  return gap;
}

std::optional<Record> CsvSource::next_row() {
  CsvRow row;
  if (!reader_->next(row)) return std::nullopt;
  std::optional<Vector> u, y, truth;
  std::optional<Index> true_mode;
  std::optional<std::int64_t> k;
  if (row.problem.empty() && row.fields.size() == width_) {
    u = numbers(row, inputs_);
    y = numbers(row, outputs_);
    truth = numbers(row, truth_);
    true_mode = mode(row);
    k = step(row, clock_);
  }
  if (!k || !u || !y || !truth || (!true_mode && !mode_.names.empty()))
    throw Error(Errc::io, file_.string() + " was changed while it was read (line " +
                              std::to_string(row.line) + ")");
  Record record{{static_cast<Index>(*k), std::move(*u), std::move(*y)}, std::nullopt, std::nullopt};
  Sample& sample = record.sample;
  for (Index i = 0; i < sample.y.size(); ++i) {
    if (std::isnan(sample.y[i])) sample.missing.push_back(i);
  }
  if (!truth_.names.empty()) record.truth = std::move(truth);
  record.mode = true_mode;
  return record;
}

}  // namespace cordon::detail
