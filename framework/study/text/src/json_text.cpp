// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/json_text.hpp"

#include <algorithm>

#include "core/text.hpp"
#include "study/text/input_file.hpp"

namespace cordon::json {

namespace {

constexpr std::size_t max_problems = 1000;

/// Printable, cut at a character after about `limit` bytes.
std::string escaped(std::string_view word, std::size_t limit) {
  if (word.size() <= limit) return detail::printable(word);
  std::size_t end = limit;
  while (end < word.size() && (static_cast<unsigned char>(word[end]) & 0xC0u) == 0x80u) ++end;
  return detail::printable(word.substr(0, end)) + (end < word.size() ? "..." : "");
}

const Parts& no_parts() {
  static const Parts none;
  return none;
}

}  // namespace

const std::string& Value::text() const { return parts ? parts->text : no_parts().text; }
const std::vector<Value>& Value::items() const { return parts ? parts->items : no_parts().items; }
const std::vector<std::string>& Value::keys() const {
  return parts ? parts->keys : no_parts().keys;
}

const Value* Value::find(std::string_view key) const {
  const auto& all = keys();
  const auto at = std::find(all.begin(), all.end(), key);
  return at == all.end() ? nullptr : &items()[static_cast<std::size_t>(at - all.begin())];
}

std::string_view kind_name(Value::Kind kind) noexcept {
  switch (kind) {
    case Value::Kind::null:
      return "null";
    case Value::Kind::boolean:
      return "true or false";
    case Value::Kind::number:
      return "a number";
    case Value::Kind::text:
      return "a text";
    case Value::Kind::array:
      return "a list";
    case Value::Kind::object:
      return "an object";
    case Value::Kind::broken:
      return "broken";
  }
  return "broken";
}

std::string in_quotes(std::string_view word, std::size_t limit) {
  return '"' + escaped(word, limit) + '"';
}

std::string child(std::string_view pointer, std::string_view key) {
  std::string text(pointer);
  text += '/';
  for (const char c : key) {
    if (c == '~') {
      text += "~0";
    } else if (c == '/') {
      text += "~1";
    } else {
      text += c;
    }
  }
  return text;
}

std::string child(std::string_view pointer, std::size_t index) {
  return std::string(pointer) + '/' + std::to_string(index);
}

void Problems::add(std::string pointer, int line, std::string message, std::string suggestion) {
  if (++count_ > max_problems) return;
  found_.push_back({escaped(pointer, 300), std::move(message), std::move(suggestion), line});
}

void Problems::add_unknown(std::string pointer, int line, std::string message,
                           std::string suggestion) {
  if (count_ < max_problems) unknown_.insert(escaped(pointer, 300));
  add(std::move(pointer), line, std::move(message), std::move(suggestion));
}

std::vector<Diagnostic> Problems::sorted() const {
  std::vector<Diagnostic> result = found_;
  std::stable_sort(result.begin(), result.end(),
                   [](const Diagnostic& a, const Diagnostic& b) { return a.line < b.line; });
  if (count_ > max_problems) {
    result.push_back({"", "and " + std::to_string(count_ - max_problems) + " more problems",
                      "repair these first", 0});
  }
  return result;
}

std::string read_file(const std::string& file) {
  return detail::InputFile(file, "name a JSON file that can be read")
      .rest(max_bytes, "recorded data belong into a CSV file");
}

}  // namespace cordon::json
