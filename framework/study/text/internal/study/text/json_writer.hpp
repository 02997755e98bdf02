// SPDX-License-Identifier: GPL-3.0-or-later
// JSON as a stream: nothing of the document is kept, so that a file of any length takes constant
// memory.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/core/types.hpp"
#include "study/text/sink.hpp"

namespace cordon::detail {

/// Text as a JSON string with its quotes: `"`, `\` and control characters escaped, bytes that are
/// no UTF-8 replaced by U+FFFD.
std::string json_string(std::string_view text);

/// Writes values one after another; commas, colons and line ends are its business. Doubles are
/// shortest round-trip, infinities the strings "inf" and "-inf", NaN is null. A wrong order of
/// calls (a key outside an object, …) throws Errc::internal.
class JsonWriter {
 public:
  /// How a container is laid out: its elements on one line, or one per line; `open_lines` closes on
  /// a line of its own even if there are none.
  enum class Layout { line, lines, open_lines };

  explicit JsonWriter(Sink& sink) : sink_(&sink) {}
  /// Goes on with an object that was written with `Layout::lines` and has members, but no end.
  static JsonWriter going_on(Sink& sink) {
    JsonWriter writer(sink);
    writer.levels_.push_back({'}', Layout::lines, false});
    return writer;
  }

  JsonWriter& begin_object(Layout layout = Layout::line) { return begin('{', layout); }
  JsonWriter& end_object() { return end('}'); }
  JsonWriter& begin_array(Layout layout = Layout::line) { return begin('[', layout); }
  JsonWriter& end_array() { return end(']'); }
  JsonWriter& key(std::string_view name);

  JsonWriter& value(double x);
  JsonWriter& value(std::string_view text) { return raw(json_string(text)); }
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  template <std::same_as<bool> Flag>  // a pointer must not pass for a flag
  JsonWriter& value(Flag flag) {
    return raw(flag ? "true" : "false");
  }
  template <std::signed_integral Integer>
  JsonWriter& value(Integer number) {
    return raw(std::to_string(number));
  }
  JsonWriter& null() { return raw("null"); }
  JsonWriter& value(VectorIn numbers);     ///< [1, 2]
  JsonWriter& matrix(MatrixIn numbers);    ///< rows: [[1, 2], [3, 4]]
  JsonWriter& raw(std::string_view json);  ///< a complete JSON value as it is

  template <class Value>
  JsonWriter& member(std::string_view name, const Value& content) {
    return key(name).value(content);
  }

 private:
  struct Level {
    char closing;
    Layout layout;
    bool empty = true;
  };

  JsonWriter& begin(char opening, Layout layout);
  JsonWriter& end(char closing);
  void separate();
  void new_line(std::size_t depth);

  Sink* sink_;
  std::vector<Level> levels_;
  bool after_key_ = false;
};

}  // namespace cordon::detail
