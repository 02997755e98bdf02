// SPDX-License-Identifier: GPL-3.0-or-later
#include "json_layout.hpp"

#include <algorithm>
#include <cmath>

#include "study/text/json_writer.hpp"
#include "study/text/string_sink.hpp"

namespace cordon::json {

namespace {

using detail::JsonWriter;
constexpr std::size_t width = 120;
enum class Form { any, line, lines };  ///< what is flat stands on one line anyway

bool is_flat(const Json& value) {
  return !value.is_structured() || value.empty() ||
         (value.is_array() && std::none_of(value.begin(), value.end(),
                                           [](const Json& v) { return v.is_structured(); }));
}

/// Is the compact text shorter than `most`? Ends early for large values.
bool fits(const Json& value, std::size_t& most) {
  const std::size_t own = value.is_structured() ? 2 : value.dump().size();
  if (own > most) return false;
  most -= own;
  if (!value.is_structured()) return true;
  for (const auto& [key, member] : value.items()) {
    const std::size_t head = 2 + (value.is_object() ? key.size() + 4 : 0);
    if (head > most) return false;
    most -= head;
    if (!fits(member, most)) return false;
  }
  return true;
}

void print(const Json& value, std::size_t indent, Form form, JsonWriter& json) {
  if (!value.is_structured()) {
    json.raw(value.dump());
    return;
  }
  std::size_t most = indent < width ? width - indent : 0;
  if (form == Form::any && fits(value, most)) form = Form::line;
  const bool in_line = form == Form::line || is_flat(value);
  const auto layout = in_line ? JsonWriter::Layout::line : JsonWriter::Layout::lines;
  value.is_array() ? json.begin_array(layout) : json.begin_object(layout);
  for (const auto& [key, member] : value.items()) {
    if (value.is_object()) json.key(key);
    print(member, indent + 2, in_line ? Form::line : Form::any, json);
  }
  value.is_array() ? json.end_array() : json.end_object();
}

}  // namespace

std::string pretty(const Json& value) {
  detail::StringSink text;
  JsonWriter json(text);
  print(value, 0, Form::lines, json);
  return text.text + "\n";
}

Json to_json(double x) {
  if (std::isinf(x)) return x > 0 ? "inf" : "-inf";
  const bool whole =
      x == std::floor(x) && std::abs(x) <= 9007199254740992.0 && !(x == 0 && std::signbit(x));
  return whole ? Json(static_cast<std::int64_t>(x)) : Json(x);
}

Json to_json(MatrixIn A) {
  Json rows = Json::array();
  for (Index i = 0; i < A.rows(); ++i) {
    Json row = Json::array();
    for (Index j = 0; j < A.cols(); ++j) row.push_back(to_json(A(i, j)));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json to_sparse(MatrixIn A) {
  Json entries = Json::array();
  for (Index j = 0; j < A.cols(); ++j) {
    for (Index i = 0; i < A.rows(); ++i) {
      if (A(i, j) != 0 || std::signbit(A(i, j)))
        entries.push_back(Json{i + 1, j + 1, to_json(A(i, j))});
    }
  }
  return {{"rows", A.rows()}, {"cols", A.cols()}, {"entries", std::move(entries)}};
}

}  // namespace cordon::json
