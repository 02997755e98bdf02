// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "study/text/json_writer.hpp"
#include "study/text/string_sink.hpp"

namespace cordon::detail {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

void write_numbers_of(JsonWriter& json, const char* key, const PointResult& result, bool measured) {
  json.key(key).begin_object();
  for (const ResultNumber& number : result.numbers) {
    if (number.column.measured == measured && !std::isnan(number.value))
      json.member(number.column.name, number.value);
  }
  json.end_object();
}

}  // namespace

std::optional<Errc> error_code(std::string_view name) {
  for (const Errc code :
       {Errc::dimension, Errc::not_finite, Errc::invalid, Errc::unsupported, Errc::not_enclosed,
        Errc::solver, Errc::time_limit, Errc::plugin, Errc::io, Errc::violated, Errc::internal}) {
    if (to_string(code) == name) return code;
  }
  return std::nullopt;
}

std::string line_of(const PointResult& result) {
  StringSink sink;
  JsonWriter json(sink);
  json.begin_object().member("point", result.index);
  write_numbers_of(json, "numbers", result, false);
  write_numbers_of(json, "measured", result, true);
  if (!result.error.empty()) json.member("error", result.error);
  if (result.code) json.member("code", to_string(*result.code));
  json.end_object();
  return std::move(sink.text);
}

std::optional<PointResult> point_of(std::string_view line) {
  json::Problems problems;
  const json::Value tree = json::parse(line, problems);
  const json::Cursor root(tree, "", problems);
  if (!root.expect_keys({"point", "numbers", "measured", "error", "code"}, "member of a point", ""))
    return std::nullopt;
  PointResult result;
  const auto point = root.need("point", "");
  result.index = point ? json::read_integer(*point, 0, json::max_integer).value_or(0) : 0;
  for (const bool measured : {false, true}) {
    const auto numbers = root.need(measured ? "measured" : "numbers", "");
    if (!numbers || !read_numbers(*numbers, measured, result.numbers)) return std::nullopt;
  }
  if (const auto error = root.find("error"))
    result.error = json::read_text(*error, json::max_bytes).value_or("");
  if (const auto code = root.find("code"); code && code->is(json::Value::Kind::text))
    result.code = error_code(code->value().text());
  return problems.any() ? std::nullopt : std::optional(std::move(result));
}

bool read_numbers(const json::Cursor& at, bool measured, std::vector<ResultNumber>& numbers) {
  if (!at.expect(json::Value::Kind::object, "")) return false;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const json::Value& value = at.value().items()[i];
    double number = value.number;
    if (value.kind == json::Value::Kind::text &&
        (value.text() == "inf" || value.text() == "-inf")) {
      number = value.text() == "inf" ? infinity : -infinity;
    } else if (value.kind != json::Value::Kind::number) {
      at.problems().add(at.pointer(), value.line, "is no number");
      return false;
    }
    numbers.push_back({{at.value().keys()[i], measured}, number});
  }
  return true;
}

void SweepRows::add(const PointResult& result) {
  Row row{{}, result.error, result.code};
  for (const ResultNumber& number : result.numbers)
    row.numbers.emplace_back(id(number.column), number.value);
  const bool failed = !row.error.empty();
  if (rows_.try_emplace(result.index, std::move(row)).second) failed_ += failed;
}

bool SweepRows::extend(const PointResult& more) {
  const auto row = rows_.find(more.index);
  if (row == rows_.end()) return false;
  for (const ResultNumber& number : more.numbers)
    row->second.numbers.emplace_back(id(number.column), number.value);
  return true;
}

void SweepRows::merge(const SweepRows& other) {
  for (const auto& [index, row] : other.rows_) {
    PointResult point{index, {}, row.error, row.code};
    for (const auto& [name, value] : row.numbers)
      point.numbers.push_back({other.names_[name], value});
    add(point);
  }
}

std::size_t SweepRows::id(const ResultColumn& column) {
  const auto [found, is_new] = ids_.try_emplace({column.name, column.measured}, names_.size());
  if (is_new) names_.push_back(column);
  return found->second;
}

std::optional<Errc> SweepRows::first_error() const {
  const auto found = std::find_if(rows_.begin(), rows_.end(),
                                  [](const auto& row) { return !row.second.error.empty(); });
  return found == rows_.end() ? std::nullopt : found->second.code;
}

std::optional<Errc> SweepRows::code(std::int64_t index) const {
  const auto row = rows_.find(index);
  return row == rows_.end() ? std::nullopt : row->second.code;
}

ResultTable SweepRows::table(const Study& study) const {
  ResultTable table;
  table.title = study.title;
  table.axes = study.sweep;
  for (const PipelineSpec& pipeline : study.pipelines) table.pipelines.push_back(pipeline.name);
  constexpr std::size_t unused = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> place(
      names_.size(), unused);  // of a name among the columns: names came as points were done
  for (const auto& [index, row] : rows_) {
    for (const auto& [name, value] : row.numbers) {
      if (place[name] != unused) continue;
      place[name] = table.columns.size();
      table.columns.push_back(names_[name]);
    }
  }
  const SweepGrid grid(study);
  for (const auto& [index, row] : rows_) {
    const SweepPoint point = grid[index];
    ResultRow& made = table.rows.emplace_back();
    made.pipeline = point.pipeline;
    made.at = point.at;
    made.values.assign(table.columns.size(), nan);
    for (const auto& [name, value] : row.numbers) made.values[place[name]] = value;
    made.error = row.error;
  }
  return table;
}

std::int64_t violations(const ResultTable& table) {
  std::vector<std::pair<std::size_t, double>>
      columns;  // of a time, or of a count: values from here on are violations
  for (std::size_t j = 0; j < table.columns.size(); ++j) {
    const std::string& name = table.columns[j].name;
    if (name == "violated_at" || name == "inner_outside") columns.emplace_back(j, 0);
    if (name == "refuted_claims") columns.emplace_back(j, 1);
  }
  return std::count_if(table.rows.begin(), table.rows.end(), [&](const ResultRow& row) {
    return std::any_of(columns.begin(), columns.end(), [&](const auto& column) {
      return row.values[column.first] >= column.second;
    });
  });
}

}  // namespace cordon::detail
