// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "cordon/core/error.hpp"
#include "cordon/study/online.hpp"
#include "study/text/json_cursor.hpp"
#include "study/text/numbers.hpp"

namespace cordon {

namespace {

using json::Cursor;
using json::in_quotes;
using json::Problems;
using json::Value;

constexpr double missing_value = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_bytes = std::size_t{1} << 20;
constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// The fields of a row, in quotes or not. Nothing where quotes do not end.
std::optional<std::vector<std::string>> fields_of(std::string_view row) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const char c = row[i];
    if (c == '"' && quoted && i + 1 < row.size() && row[i + 1] == '"') {
      fields.back() += row[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  if (quoted) return std::nullopt;
  for (std::string& field : fields) field = std::string(trimmed(field));
  return fields;
}

bool is_missing_field(const std::string& field) {
  return field.empty() || field == "nan" || field == "NaN" || field == "null";
}

}  // namespace

class SampleLines::Reader {
 public:
  explicit Reader(const Study& study)
      : inputs_(study.model.inputs()),
        outputs_(study.model.outputs()),
        has_clock_(study.labels.sampling_time > 0) {
    const auto* recorded = std::get_if<CsvSpec>(&study.data);
    const std::vector<std::string> none;
    t_names_ = {"t", "t [s]", "time", "time [s]"};
    if (recorded && !recorded->time.empty()) t_names_.insert(t_names_.begin(), recorded->time);
    u_ = columns_of("u", inputs_, study.labels.inputs, recorded ? recorded->inputs : none);
    y_ = columns_of("y", outputs_, study.labels.outputs, recorded ? recorded->outputs : none);
  }

  GivenLine read(std::string_view line) {
    std::string_view text = trimmed(line);
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.empty()) return {};
    Problems problems;
    GivenLine given;
    if (text.size() > most_bytes) {
      problems.add("", 0, "the line is longer than 1 MiB", "a line is one sample");
    } else if (text.front() == '{') {
      given = from_json(text, problems);
    } else if (header_) {
      given.sample = from_row(text, problems);
    } else {
      read_header(text, problems);
    }
    if (problems.any()) throw InputError("sample", helped(problems.sorted()));
    return given;
  }

  std::vector<std::string> passed_over() const {
    std::vector<std::string> names;
    for (std::size_t i = 0; header_ && i < header_->size(); ++i) {
      const auto is_it = [i](const Column& column) { return column.at == i; };
      const bool is_used =
          i == k_ || i == t_ || std::ranges::any_of(u_, is_it) || std::ranges::any_of(y_, is_it);
      if (!is_used) names.push_back((*header_)[i]);
    }
    return names;
  }

  bool have_times() const { return !header_ || k_ != nowhere || t_ != nowhere; }

 private:
  /// Programs write NaN for what is missing.
  static std::vector<Diagnostic> helped(std::vector<Diagnostic> problems) {
    for (Diagnostic& problem : problems) {
      if (problem.pointer.starts_with("/y/") && problem.message.starts_with("NaN"))
        problem.suggestion = "write null for an output that is missing";
    }
    return problems;
  }

  /// A column under one of its names: that of the recorded data, of the label, or u_1, y_2.
  struct Column {
    std::vector<std::string> names;
    std::size_t at = nowhere;
  };

  static std::vector<Column> columns_of(const std::string& symbol, Index count,
                                        const Labels::Names& labels,
                                        const std::vector<std::string>& recorded) {
    std::vector<Column> columns;
    for (Index i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      Column column;
      if (at < recorded.size()) column.names.push_back(recorded[at]);
      column.names.push_back(heading_of(labels, symbol, i));
      if (at < labels.size()) column.names.push_back(labels[at]);
      column.names.push_back(symbol + "_" + std::to_string(i + 1));
      columns.push_back(std::move(column));
    }
    return columns;
  }

  GivenLine from_json(std::string_view text, Problems& problems) const {
    const Value tree = json::parse(text, problems);
    const Cursor root(tree, "", problems);
    if (problems.any() || !root.expect(Value::Kind::object, "write {\"u\": [...], \"y\": [...]}"))
      return {};
    if (root.find("do")) return {std::nullopt, request_of(root)};
    root.expect_keys({"k", "t", "u", "y", "do"}, "member",
                     "a sample has \"k\" or \"t\", \"u\" and \"y\"");
    GivenSample sample;
    if (const auto k = root.find("k")) {
      if (const auto number = json::read_integer(*k, 0, json::max_integer)) sample.k = *number;
    }
    if (const auto t = root.find("t")) {
      if (const auto seconds = json::read_number(*t)) sample.t = *seconds;
    }
    sample.u = numbers(root, "u", inputs_, false);
    sample.y = numbers(root, "y", outputs_, true);
    return {std::move(sample), std::nullopt};
  }

  static std::optional<Request> request_of(const Cursor& root) {
    root.expect_keys({"do"}, "member", "a request has \"do\" alone");
    const auto choice = json::read_choice(*root.find("do"), {"acknowledge", "start"});
    if (!choice) return std::nullopt;
    return *choice == "acknowledge" ? Request::acknowledge : Request::start;
  }

  /// Outputs may be null, and so may be the list of all of them.
  static Vector numbers(const Cursor& root, const char* key, Index count, bool may_be_missing) {
    Vector values = Vector::Constant(count, missing_value);
    const auto list = root.find(key);
    const bool is_null = list && list->is(Value::Kind::null);
    if ((!list || is_null) && (may_be_missing || (count == 0 && !list))) return values;
    if (!list) {
      root.error("\"" + std::string(key) + "\" is missing",
                 "every sample has its " + json::counted(count, "input"));
      return values;
    }
    if (!list->expect(Value::Kind::array, "give a list of " + json::counted(count, "number")))
      return values;
    if (static_cast<Index>(list->size()) != count) {
      list->error("has " + json::counted(static_cast<Index>(list->size()), "number") +
                      ", the system has " +
                      json::counted(count, may_be_missing ? "output" : "input"),
                  may_be_missing ? "write null for an output that is missing" : "");
      return values;
    }
    for (Index i = 0; i < count; ++i) {
      const Cursor entry = list->item(static_cast<std::size_t>(i));
      if (may_be_missing && entry.is(Value::Kind::null)) continue;
      values[i] = json::read_number(entry).value_or(0);
    }
    return values;
  }

  void read_header(std::string_view text, Problems& problems) {
    const auto names = fields_of(text);
    if (!names) {
      problems.add("", 0, "the header row has quotes that do not end");
      return;
    }
    if (std::ranges::all_of(*names, is_value) &&
        std::ranges::none_of(*names, [this](auto& name) { return is_known(name); })) {
      problems.add("", 0, "is a row of numbers, and no header row has named its columns",
                   "the first row has the names, such as " + names_of_all());
      return;
    }
    std::vector<int> uses(names->size());
    k_ = place({"k"}, *names, uses, problems);
    t_ = has_clock_ && k_ == nowhere ? place(t_names_, *names, uses, problems) : nowhere;
    for (Column& column : u_) find(column, *names, uses, problems);
    for (Column& column : y_) find(column, *names, uses, problems);
    for (std::size_t i = 0; i < uses.size(); ++i) {
      if (uses[i] > 1)
        problems.add("", 0, "the column " + in_quotes((*names)[i]) + " would be of several signals",
                     "name the columns as the study names inputs and outputs");
    }
    if (problems.any() && text.find_first_of(";\t") != std::string_view::npos)
      problems.add("", 0, "has \";\" or tabs", "columns are separated by commas");
    if (!problems.any()) header_ = *names;
  }

  /// As the name of a column; a number may be one.
  bool is_known(const std::string& name) const {
    const auto has_name = [&](const Column& column) {
      return std::ranges::find(column.names, name) != column.names.end();
    };
    return std::ranges::any_of(u_, has_name) || std::ranges::any_of(y_, has_name);
  }

  static bool is_value(const std::string& field) {
    return is_missing_field(field) || detail::parse_number(field).problem.empty();
  }

  /// u_1,y_1,y_2
  std::string names_of_all() const {
    std::string text;
    for (const auto* columns : {&u_, &y_}) {
      for (const Column& column : *columns) text += (text.empty() ? "" : ",") + column.names.back();
    }
    return text;
  }

  static std::size_t place(const std::vector<std::string>& names,
                           const std::vector<std::string>& header, std::vector<int>& uses,
                           Problems& problems) {
    for (const std::string& name : names) {
      const auto found = std::ranges::find(header, name);
      if (found == header.end()) continue;
      if (std::ranges::count(header, name) > 1)
        problems.add("", 0, "the column " + in_quotes(name) + " appears more than once",
                     "rename one of them");
      const auto at = static_cast<std::size_t>(found - header.begin());
      ++uses[at];
      return at;
    }
    return nowhere;
  }

  static void find(Column& column, const std::vector<std::string>& header, std::vector<int>& uses,
                   Problems& problems) {
    column.at = place(column.names, header, uses, problems);
    if (column.at != nowhere) return;
    const std::vector<std::string> some(
        header.begin(), header.begin() + std::min<std::ptrdiff_t>(30, std::ssize(header)));
    problems.add("", 0,
                 "there is no column " + in_quotes(column.names.front()) + or_another(column) +
                     " in the header",
                 suggest(column.names.front(), some));
  }

  /// Its other name.
  static std::string or_another(const Column& column) {
    const std::string& other = column.names.back();
    return other == column.names.front() ? "" : " or " + in_quotes(other);
  }

  std::optional<GivenSample> from_row(std::string_view text, Problems& problems) const {
    const auto fields = fields_of(text);
    if (!fields || fields->size() != header_->size()) {
      problems.add("", 0,
                   fields ? "the row has " + json::counted(std::ssize(*fields), "field") +
                                ", the header " + std::to_string(header_->size())
                          : "the row has quotes that do not end",
                   "each row has a field for each column, also where it is empty");
      return std::nullopt;
    }
    GivenSample sample;
    if (k_ != nowhere && !(*fields)[k_].empty()) {
      const double k = number((*fields)[k_], "k", problems);
      if (!(k >= 0) || k != std::floor(k) || k > json::max_integer) {
        problems.add("", 0, "column \"k\": no number of a step", "steps are counted from 0");
      } else {
        sample.k = static_cast<Index>(k);
      }
    }
    if (t_ != nowhere && !(*fields)[t_].empty())
      sample.t = number((*fields)[t_], (*header_)[t_], problems,
                        "it holds seconds; a column of another name is passed over");
    sample.u = numbers(u_, *fields, false, problems);
    sample.y = numbers(y_, *fields, true, problems);
    return sample;
  }

  static Vector numbers(const std::vector<Column>& columns, const std::vector<std::string>& fields,
                        bool may_be_missing, Problems& problems) {
    Vector values = Vector::Constant(std::ssize(columns), missing_value);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string& field = fields[columns[i].at];
      if (may_be_missing && is_missing_field(field)) continue;
      values[static_cast<Index>(i)] = number(field, columns[i].names.back(), problems);
    }
    return values;
  }

  static double number(const std::string& field, const std::string& column, Problems& problems,
                       const char* suggestion = "") {
    const detail::ParsedNumber number = detail::parse_number(field);
    if (!number.problem.empty())
      problems.add("", 0, "column " + in_quotes(column) + ": " + number.problem, suggestion);
    return number.value;
  }

  Index inputs_, outputs_;
  bool has_clock_;
  std::vector<std::string> t_names_;
  std::vector<Column> u_, y_;
  std::size_t k_ = nowhere, t_ = nowhere;
  std::optional<std::vector<std::string>> header_;
};

SampleLines::SampleLines(const Study& study) : reader_(std::make_unique<Reader>(study)) {}
SampleLines::~SampleLines() = default;
SampleLines::SampleLines(SampleLines&&) noexcept = default;
SampleLines& SampleLines::operator=(SampleLines&&) noexcept = default;
GivenLine SampleLines::read(std::string_view line) { return reader_->read(line); }
std::vector<std::string> SampleLines::passed_over() const { return reader_->passed_over(); }
bool SampleLines::have_times() const { return reader_->have_times(); }

}  // namespace cordon
