// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <charconv>
#include <unordered_map>

// The library expects the decimal point of the locale to be one byte, which it is not everywhere;
// its own values of numbers are not used here.
#define JSON_ASSERT(condition) static_cast<void>(0)
#include <nlohmann/json.hpp>

#include "core/text.hpp"
#include "json_fault.hpp"
#include "json_source.hpp"
#include "study/text/byte_iterator.hpp"
#include "study/text/json_text.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;

/// Builds the tree of what the library's parser finds in a text.
class Builder {
 public:
  Builder(std::string_view text, Source& source, Problems& problems)
      : text_(text), source_(source), problems_(problems) {}

  Value take() { return std::move(root_); }

  bool null() {
    const std::string_view word = source_.take_infinite();
    return leaf(word.empty() ? Kind::null : Kind::broken, [&](Value&) {
      if (word.empty()) return;
      problems_.add(
          pointer(), line_, std::string(word) + " is not a number",
          "numbers are finite; only bounds of a box may be free: \"-inf\" and \"inf\" in quotes");
    });
  }
  bool boolean(bool flag) {
    return leaf(Kind::boolean, [&](Value& value) { value.flag = flag; });
  }
  // The library was shown no more than their shape.
  bool number_integer(std::int64_t) { return number(); }
  bool number_unsigned(std::uint64_t) { return number(); }
  bool number_float(double, const std::string&) { return number(); }
  bool string(std::string& text) {
    return leaf(Kind::text, [&](Value& value) {
      const auto parts = std::make_shared<Parts>();
      parts->text = text;  // as large as needed; the library keeps its own
      value.parts = parts;
    });
  }
  bool binary(const std::vector<std::uint8_t>&) { return false; }  // not part of JSON text
  bool start_object(std::size_t) { return open(Kind::object, Last::opened_object); }
  bool start_array(std::size_t) { return open(Kind::array, Last::opened_array); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& text) {
    go_to_token();
    forget_repeated();
    keys_.push_back(text);
    open_.back().key_line = line_;
    pass(source_.position(), Last::key);
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) {
    return refuse(fault_of(text_, at_, last_, keys_.empty() ? std::string_view() : keys_.back()));
  }
  /// Reports what ends the reading.
  bool refuse(Fault fault);

 private:
  /// A list or an object that is not complete. Its items and keys are the last ones of `items_` and
  /// `keys_`.
  struct Level {
    Value value;
    std::size_t items, keys;  ///< where its own begin
    int key_line = 0;
    std::unordered_map<std::string, int> lines = {};  ///< of the items by their keys; once many
  };
  static constexpr std::size_t few_keys = 16;

  void go_to_token();
  void pass(std::size_t end, Last last) {
    at_ = end;
    last_ = last;
  }
  bool number();
  template <class Fill>
  bool leaf(Kind kind, Fill&& fill);
  bool open(Kind kind, Last last);
  bool close();
  bool begin(Kind kind, Value& value);
  bool put(Value value, std::size_t end);
  int line_of_same_key(const Value& value);
  void forget_repeated() { keys_.resize(open_.back().keys + items_.size() - open_.back().items); }
  /// Of the value that is read, an element of the innermost list being the next one.
  std::string pointer(Fault::Of of = Fault::Of::next) const;

  std::string_view text_;
  Source& source_;
  Problems& problems_;
  std::vector<Level> open_;
  std::vector<Value> items_;
  std::vector<std::string> keys_;  ///< one more than items in an object while its value is read
  std::size_t at_ = 0;             ///< the beginning of a token, or the end of the last one
  int line_ = 1;                   ///< where that is
  Last last_ = Last::nothing;
  std::size_t values_ = 0;
  Value root_;
};

std::string Builder::pointer(Fault::Of of) const {
  std::string text;
  for (std::size_t i = 0; i < open_.size(); ++i) {
    const Level& level = open_[i];
    const bool innermost = i + 1 == open_.size();
    if (innermost && of == Fault::Of::container) break;
    if (level.value.kind == Kind::array) {
      const std::size_t items = (innermost ? items_.size() : open_[i + 1].items) - level.items;
      const bool latest = innermost && of == Fault::Of::latest && items > 0;
      text = child(text, latest ? items - 1 : items);
    } else {
      const std::size_t keys = innermost ? keys_.size() : open_[i + 1].keys;
      text = child(text, keys > level.keys ? std::string_view(keys_[keys - 1]) : "");
    }
  }
  return text;
}

bool Builder::refuse(Fault fault) {
  const std::string_view before = text_.substr(0, fault.position);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::string_view row = before.substr(before.rfind('\n') + 1);
  const auto column = 1 + std::count_if(row.begin(), row.end(), [](char c) {
                        return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u;
                      });
  problems_.add(pointer(fault.of), static_cast<int>(line),
                "column " + std::to_string(column) + ": " + std::move(fault.message),
                std::move(fault.suggestion));
  return false;
}

/// From the end of the last token to the beginning of the one that the library has found.
void Builder::go_to_token() {
  for (; is_space(text_[at_]) || text_[at_] == ',' || text_[at_] == ':'; ++at_)
    line_ += text_[at_] == '\n' ? 1 : 0;
}

bool Builder::begin(Kind kind, Value& value) {
  go_to_token();
  value.kind = kind;
  value.line = line_;
  if (++values_ <= max_values) return true;
  return refuse({at_, "the file holds more than 10 million values",
                 "recorded data belong into a CSV file", Fault::Of::next});
}

bool Builder::number() {
  Value value;
  if (!begin(Kind::number, value)) return false;
  const char* begin = text_.data() + at_;
  const char* end = text_.data() + text_.size();
  const char* digits = begin + (*begin == '-' ? 1 : 0);
  if (*digits == '0' && end - digits > 1 && is_digit(digits[1])) {  // 0 and 7 to the library
    const bool follows_digit = at_ >= 2 && text_[at_ - 1] == ',' && is_digit(text_[at_ - 2]);
    return refuse({static_cast<std::size_t>(digits - text_.data()),
                   "a number begins with a superfluous 0",
                   follows_digit ? "a decimal comma? Write 0.05, not 0,05" : "write 7, not 07",
                   Fault::Of::next});
  }
  const auto [stop, code] = std::from_chars(begin, end, value.number);
  if (code != std::errc()) {
    value.kind = Kind::broken;
    problems_.add(pointer(), line_,
                  in_quotes({begin, stop}) + " is beyond the range of double numbers",
                  "about 1e-308 to 1.8e308, or 0");
  }
  return put(std::move(value), static_cast<std::size_t>(stop - text_.data()));
}

template <class Fill>
bool Builder::leaf(Kind kind, Fill&& fill) {
  Value value;
  if (!begin(kind, value)) return false;
  fill(value);
  return put(std::move(value), source_.position());
}

bool Builder::open(Kind kind, Last last) {
  Value value;
  if (!begin(kind, value)) return false;
  if (open_.size() >= static_cast<std::size_t>(max_depth)) {
    return refuse(
        {at_, "nested deeper than 64 levels", "a study needs less than ten", Fault::Of::next});
  }
  open_.push_back({std::move(value), items_.size(), keys_.size()});
  pass(at_ + 1, last);
  return true;
}

bool Builder::close() {
  go_to_token();
  Level& level = open_.back();
  if (level.value.kind == Kind::object) forget_repeated();
  const auto parts = std::make_shared<Parts>();
  const auto items = items_.begin() + static_cast<std::ptrdiff_t>(level.items);
  const auto keys = keys_.begin() + static_cast<std::ptrdiff_t>(level.keys);
  parts->items.assign(std::make_move_iterator(items), std::make_move_iterator(items_.end()));
  parts->keys.assign(std::make_move_iterator(keys), std::make_move_iterator(keys_.end()));
  items_.erase(items, items_.end());
  keys_.erase(keys, keys_.end());
  Value value = std::move(level.value);
  value.parts = parts;
  open_.pop_back();
  return put(std::move(value), at_ + 1);
}

/// A complete value, which ends at `end`, goes into the one around it.
bool Builder::put(Value value, std::size_t end) {
  if (open_.empty()) {
    pass(end, Last::root);
    root_ = std::move(value);
    return true;
  }
  const bool is_member = open_.back().value.kind == Kind::object;
  pass(end, is_member ? Last::member : Last::element);
  const int first = is_member ? line_of_same_key(value) : 0;
  if (first > 0) {
    problems_.add(pointer(), open_.back().key_line,
                  "the key is repeated (first on line " + std::to_string(first) + ")",
                  "remove one of the two");
    return true;
  }
  items_.push_back(std::move(value));
  return true;
}

/// The line of the value in the innermost object that has the key of `value` already; 0: none.
int Builder::line_of_same_key(const Value& value) {
  Level& level = open_.back();
  const auto begin = keys_.begin() + static_cast<std::ptrdiff_t>(level.keys);
  const Value* items = items_.data() + level.items;
  const std::size_t known = items_.size() - level.items;
  if (known < few_keys) {
    const auto same = std::find(begin, keys_.end() - 1, keys_.back());
    return same == keys_.end() - 1 ? 0 : items[same - begin].line;
  }
  if (level.lines.empty()) {
    for (std::size_t i = 0; i < known; ++i)
      level.lines.emplace(begin[static_cast<std::ptrdiff_t>(i)], items[i].line);
  }
  const auto [same, is_new] = level.lines.emplace(keys_.back(), value.line);
  return is_new ? 0 : same->second;
}

/// Where the text stops being UTF-8; npos: nowhere.
std::size_t first_foreign_byte(std::string_view text) {
  for (std::size_t at = 0;; ++at) {
    while (at < text.size() && static_cast<unsigned char>(text[at]) < 0x80) ++at;
    if (at == text.size()) return std::string_view::npos;
    const std::size_t length = detail::utf8_length(text.substr(at));
    if (length == 0) return at;
    at += length - 1;
  }
}

}  // namespace

Value parse(std::string_view text, Problems& problems) {
  static constexpr std::string_view mark = "\xEF\xBB\xBF";
  if (text.starts_with(mark)) text.remove_prefix(mark.size());
  Source source(text);
  Builder builder(text, source, problems);
  if (const std::size_t at = first_foreign_byte(text); at != std::string_view::npos) {
    builder.refuse({at, "not valid UTF-8", "save the file with the encoding UTF-8"});
  } else if (text.starts_with(mark)) {  // the library would skip it
    builder.refuse(fault_of(text, 0, Last::nothing, ""));
  } else if (nlohmann::json::sax_parse(ByteIterator<Source>(&source), ByteIterator<Source>(nullptr),
                                       &builder)) {
    return builder.take();
  }
  Value broken;
  broken.kind = Kind::broken;
  return broken;
}

}  // namespace cordon::json
