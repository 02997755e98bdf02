// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "cordon/core/error.hpp"
#include "study/text/json_cursor.hpp"
#include "study/text/numbers.hpp"

namespace cordon::report {

namespace {

/// "x_1" of "x_1 level [m]".
std::string key_of(const std::string& name) {
  const std::size_t space = name.find(' ');
  const bool is_labelled =
      space != std::string::npos && space > 0 && name[space - 1] >= '0' && name[space - 1] <= '9';
  return is_labelled ? name.substr(0, space) : name;
}

}  // namespace

ColumnReader::ColumnReader(const std::filesystem::path& file) : file_(file), reader_(file) {
  if (!reader_.next(row_) || !row_.problem.empty()) refuse("has no header");
  names_ = row_.fields;
  std::set<std::string> seen;
  for (const std::string& name : names_) {
    keys_.push_back(key_of(name));
    if (!seen.insert(keys_.back()).second)
      refuse("names the column " + json::in_quotes(name) + " twice");
  }
}

std::optional<std::size_t> ColumnReader::find(const std::string& name) const {
  const auto at = std::find(keys_.begin(), keys_.end(), name);
  return at == keys_.end()
             ? std::nullopt
             : std::optional<std::size_t>(static_cast<std::size_t>(at - keys_.begin()));
}

std::size_t ColumnReader::need(const std::string& name) const {
  const auto column = find(name);
  if (!column)
    throw InputError(file_.string(),
                     {{"", "has no column " + json::in_quotes(name), "run the study again", 1}});
  return *column;
}

std::vector<std::size_t> ColumnReader::numbered(const std::string& prefix) const {
  std::vector<std::size_t> columns;
  while (const auto column = find(prefix + std::to_string(columns.size() + 1)))
    columns.push_back(*column);
  return columns;
}

bool ColumnReader::next() {
  if (!reader_.next(row_)) return false;
  if (!row_.problem.empty()) refuse(row_.problem);
  if (row_.fields.size() != names_.size()) {
    refuse("has " + json::counted(static_cast<Index>(row_.fields.size()), "field") +
           ", the header has " + std::to_string(names_.size()));
  }
  return true;
}

std::optional<double> ColumnReader::value(std::size_t column) const {
  const std::string& field = row_.fields[column];
  if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
  if (field == "inf") return infinity;
  if (field == "-inf") return -infinity;
  const detail::ParsedNumber parsed = detail::parse_number(field);
  return parsed.problem.empty() ? std::optional<double>(parsed.value) : std::nullopt;
}

double ColumnReader::number(std::size_t column) const {
  const auto number = value(column);
  if (!number)
    refuse("column " + json::in_quotes(names_[column]) + ": " +
           json::in_quotes(row_.fields[column]) + " is no number");
  return *number;
}

std::int64_t ColumnReader::integer(std::size_t column) const {
  const double x = number(column);
  if (!(std::abs(x) <= json::max_integer) || x != std::floor(x)) {
    refuse("column " + json::in_quotes(names_[column]) + ": " +
           json::in_quotes(row_.fields[column]) + " is no integer");
  }
  return static_cast<std::int64_t>(x);
}

void ColumnReader::refuse(const std::string& reason) const {
  const auto line = static_cast<int>(std::min<std::int64_t>(row_.line, 1'000'000'000));
  throw InputError(
      file_.string(),
      {{"", reason, "the file is not as \"cordon run\" wrote it; run the study again", line}});
}

}  // namespace cordon::report
