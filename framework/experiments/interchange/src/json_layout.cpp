// SPDX-License-Identifier: GPL-3.0-or-later
#include "json_layout.hpp"

#include <algorithm>
#include <cmath>

namespace cordon::json {

namespace {

constexpr std::size_t width = 120;

bool is_flat(const Json& value) {
  return !value.is_structured() || value.empty() ||
         (value.is_array() && std::none_of(value.begin(), value.end(),
                                           [](const Json& v) { return v.is_structured(); }));
}

std::string in_one_line(const Json& value) {
  if (!value.is_structured()) return value.dump();
  std::string out(1, value.is_array() ? '[' : '{');
  const char* comma = "";
  for (const auto& [key, member] : value.items()) {
    out += comma;
    if (value.is_object()) out += Json(key).dump() + ": ";
    out += in_one_line(member);
    comma = ", ";
  }
  return out + (value.is_array() ? ']' : '}');
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

void print(const Json& value, const std::string& indent, bool top, std::string& out) {
  std::size_t most = indent.size() < width ? width - indent.size() : 0;
  if (is_flat(value) || (!top && fits(value, most))) {
    out += in_one_line(value);
    return;
  }
  const std::string inner = indent + "  ";
  out += value.is_array() ? '[' : '{';
  const char* comma = "\n";
  for (const auto& [key, member] : value.items()) {
    out += comma + inner;
    if (value.is_object()) out += Json(key).dump() + ": ";
    print(member, inner, false, out);
    comma = ",\n";
  }
  out += '\n' + indent;
  out += value.is_array() ? ']' : '}';
}

}  // namespace

std::string pretty(const Json& value) {
  std::string text;
  print(value, "", true, text);
  return text + "\n";
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
