// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/json_writer.hpp"

#include <algorithm>
#include <cmath>

#include "cordon/core/error.hpp"
#include "core/text.hpp"
#include "study/text/numbers.hpp"

namespace cordon::detail {

namespace {

std::string escaped(char c) {
  switch (c) {
    case '"':
      return "\\\"";
    case '\\':
      return "\\\\";
    case '\n':
      return "\\n";
    case '\r':
      return "\\r";
    case '\t':
      return "\\t";
    default:
      break;
  }
  static constexpr char hex[] = "0123456789abcdef";
  if (static_cast<unsigned char>(c) >= 0x20) return std::string(1, c);
  return std::string("\\u00") + hex[c >> 4] + hex[c & 15];
}

}  // namespace

std::string json_string(std::string_view text) {
  std::string out = "\"";
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 1) {
      out += escaped(text[0]);
    } else {
      out += length == 0 ? std::string_view("\xEF\xBF\xBD") : text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return out + '"';
}

void JsonWriter::new_line(std::size_t depth) {
  sink_->write(std::string(1, '\n').append(2 * depth, ' '));
}

/// What stands between the previous value and the next one.
void JsonWriter::separate() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (levels_.empty()) return;
  Level& level = levels_.back();
  if (!level.empty) sink_->write(",");
  if (level.layout != Layout::line) {
    new_line(levels_.size());
  } else if (!level.empty) {
    sink_->write(" ");
  }
  level.empty = false;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  if (levels_.empty() || levels_.back().closing != '}' || after_key_)
    throw Error(Errc::internal, "JSON: a key outside an object");
  separate();
  sink_->write(json_string(name) + ": ");
  after_key_ = true;
  return *this;
}

JsonWriter& JsonWriter::raw(std::string_view json) {
  if (!levels_.empty() && levels_.back().closing == '}' && !after_key_)
    throw Error(Errc::internal, "JSON: a member without a key");
  separate();
  sink_->write(json);
  return *this;
}

JsonWriter& JsonWriter::begin(char opening, Layout layout) {
  raw(std::string_view(&opening, 1));
  levels_.push_back({opening == '{' ? '}' : ']', layout});
  return *this;
}

JsonWriter& JsonWriter::end(char closing) {
  if (levels_.empty() || levels_.back().closing != closing || after_key_)
    throw Error(Errc::internal, "JSON: unbalanced brackets");
  const Level level = levels_.back();
  levels_.pop_back();
  if (level.layout == Layout::open_lines || (level.layout == Layout::lines && !level.empty))
    new_line(levels_.size());
  sink_->write(std::string_view(&closing, 1));
  return *this;
}

JsonWriter& JsonWriter::value(double x) {
  if (std::isnan(x)) return null();
  return std::isinf(x) ? value(std::string_view(x > 0 ? "inf" : "-inf")) : raw(to_text(x));
}

JsonWriter& JsonWriter::value(VectorIn numbers) {
  begin_array();
  for (Index i = 0; i < numbers.size(); ++i) value(numbers[i]);
  return end_array();
}

JsonWriter& JsonWriter::matrix(MatrixIn numbers) {
  begin_array();
  for (Index i = 0; i < numbers.rows(); ++i) {
    begin_array();
    for (Index j = 0; j < numbers.cols(); ++j) value(numbers(i, j));
    end_array();
  }
  return end_array();
}

}  // namespace cordon::detail
