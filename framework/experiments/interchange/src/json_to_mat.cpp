// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/interchange/json_to_mat.hpp"

#include <algorithm>
#include <limits>

namespace cordon::mat {

namespace {

using JsonKind = json::Value::Kind;

bool is_row(const json::Value& value) {
  return value.kind == JsonKind::array &&
         std::all_of(value.items().begin(), value.items().end(), is_number);
}

bool is_matrix(const json::Value& value) {
  const std::vector<json::Value>& rows = value.items();
  if (rows.empty() || !std::all_of(rows.begin(), rows.end(), is_row)) return false;
  return std::all_of(rows.begin(), rows.end(), [&](const json::Value& r) {
    return r.items().size() == rows[0].items().size();
  });
}

Matrix rows_of(const std::vector<json::Value>& rows) {
  Matrix A(static_cast<Index>(rows.size()), static_cast<Index>(rows.front().items().size()));
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < A.cols(); ++j) {
      A(i, j) = number_of(rows[static_cast<std::size_t>(i)].items()[static_cast<std::size_t>(j)]);
    }
  }
  return A;
}

Matrix row_of(const json::Value& list) {
  Matrix row(1, static_cast<Index>(list.items().size()));
  for (Index j = 0; j < row.cols(); ++j)
    row(0, j) = number_of(list.items()[static_cast<std::size_t>(j)]);
  return row;
}

bool is_exchange_form(const json::Value& object) {
  const auto has = [&](const char* key) { return object.find(key) != nullptr; };
  return has("M") && has("G") && has("c") && has("S") && has("A") && has("b");
}

Value object_to_mat(const json::Value& object) {
  const std::vector<std::string> names = valid_names(object.keys());
  const bool form = is_exchange_form(object);
  Struct fields;
  for (std::size_t i = 0; i < names.size(); ++i) {
    Value item = to_mat(object.items()[i]);
    if (form && (names[i] == "c" || names[i] == "b"))
      item.numbers = item.numbers.transpose().eval();
    fields.set(names[i], std::move(item));
  }
  return std::move(fields).value();
}

}  // namespace

bool is_number(const json::Value& value) {
  if (value.kind == JsonKind::text) return value.text() == "inf" || value.text() == "-inf";
  return value.kind == JsonKind::number || value.kind == JsonKind::null;
}

double number_of(const json::Value& value) {
  if (value.kind == JsonKind::text) return value.text() == "-inf" ? -infinity : infinity;
  return value.kind == JsonKind::number ? value.number : std::numeric_limits<double>::quiet_NaN();
}

Value to_mat(const json::Value& value) {
  if (is_number(value)) return number(number_of(value));
  if (value.kind == JsonKind::boolean) return number(value.flag ? 1 : 0);
  if (value.kind == JsonKind::text) return text(value.text());
  if (value.kind == JsonKind::object) return object_to_mat(value);
  if (is_matrix(value)) return matrix(rows_of(value.items()));
  if (is_row(value)) return matrix(row_of(value));
  std::vector<Value> items;
  for (const json::Value& item : value.items()) items.push_back(to_mat(item));
  return cell(std::move(items));
}

}  // namespace cordon::mat
