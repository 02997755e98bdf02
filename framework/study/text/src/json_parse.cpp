// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <charconv>
#include <unordered_set>

#include "study/text/json_text.hpp"

namespace cordon::json {

namespace {

/// Position of the first byte that is not part of valid UTF-8 (RFC 3629), or npos.
std::size_t first_invalid_utf8(std::string_view text) {
  std::size_t i = 0;
  while (i < text.size()) {
    const auto lead = static_cast<unsigned char>(text[i]);
    std::size_t length = 0;
    unsigned low = 0x80, high = 0xBF;  // range of the second byte: refuses overlong forms,
                                       // surrogates and values over 10FFFF
    if (lead < 0x80) {
      length = 1;
    } else if (lead >= 0xC2 && lead <= 0xDF) {
      length = 2;
    } else if (lead >= 0xE0 && lead <= 0xEF) {
      length = 3;
      low = lead == 0xE0 ? 0xA0u : low;
      high = lead == 0xED ? 0x9Fu : high;
    } else if (lead >= 0xF0 && lead <= 0xF4) {
      length = 4;
      low = lead == 0xF0 ? 0x90u : low;
      high = lead == 0xF4 ? 0x8Fu : high;
    }
    if (length == 0 || i + length > text.size()) return i;
    for (std::size_t j = 1; j < length; ++j) {
      const auto byte = static_cast<unsigned char>(text[i + j]);
      if (byte < (j == 1 ? low : 0x80u) || byte > (j == 1 ? high : 0xBFu)) return i;
    }
    i += length;
  }
  return std::string_view::npos;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

struct SyntaxError {
  std::size_t position;
  std::string message, suggestion;
};

class Parser {
 public:
  Parser(std::string_view text, Problems& problems) : text_(text), problems_(problems) {}

  Value document();

 private:
  struct Step {
    std::string key;
    std::size_t index = 0;
    bool in_array = false;
  };

  Value value();
  Value object();
  Value array();
  Value number();
  Value word();
  std::string string();
  unsigned hex4();
  void escape(std::string& out);
  Value broken_number(std::string message, std::string suggestion);
  Value of_kind(Value::Kind kind) const;

  void skip_space();
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool at_end() const { return at_ >= text_.size(); }
  bool next_is(char c) const { return !at_end() && text_[at_] == c; }
  bool take(char c) { return next_is(c) && ++at_ > 0; }
  [[noreturn]] void fail(std::string message, std::string suggestion = "") const {
    fail_at(at_, std::move(message), std::move(suggestion));
  }
  [[noreturn]] static void fail_at(std::size_t position, std::string message,
                                   std::string suggestion = "") {
    throw SyntaxError{position, std::move(message), std::move(suggestion)};
  }
  std::string found() const;
  std::string pointer() const;
  void report_syntax(std::size_t position, std::string message, std::string suggestion);

  std::string_view text_;
  Problems& problems_;
  std::size_t at_ = 0;
  int line_ = 1;
  std::size_t values_ = 0;
  std::vector<Step> path_;
};

std::string Parser::pointer() const {
  std::string text;
  for (const Step& step : path_)
    text = step.in_array ? child(text, step.index) : child(text, step.key);
  return text;
}

std::string Parser::found() const {
  if (at_end()) return "the file ends here";
  std::size_t end = at_ + 1;
  while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0u) == 0x80u)
    ++end;  // a whole character
  if (is_word(peek()))
    end = static_cast<std::size_t>(
        std::find_if_not(text_.begin() + static_cast<std::ptrdiff_t>(at_), text_.end(), is_word) -
        text_.begin());
  return "found " +
         (peek() == '"' ? std::string("a text") : in_quotes(text_.substr(at_, end - at_)));
}

void Parser::report_syntax(std::size_t position, std::string message, std::string suggestion) {
  const std::string_view before = text_.substr(0, position);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::string_view row =
      before.substr(before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1);
  const auto column = 1 + std::count_if(row.begin(), row.end(), [](char c) {
                        return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u;
                      });
  problems_.add(pointer(), static_cast<int>(line),
                "column " + std::to_string(column) + ": " + std::move(message),
                std::move(suggestion));
}

Value Parser::document() {
  if (text_.substr(0, 3) == "\xEF\xBB\xBF") text_.remove_prefix(3);
  if (const std::size_t bad = first_invalid_utf8(text_); bad != std::string_view::npos) {
    report_syntax(bad, "not valid UTF-8", "save the file with the encoding UTF-8");
    return of_kind(Value::Kind::broken);
  }
  try {
    skip_space();
    Value root = value();
    skip_space();
    if (!at_end())
      fail("more text after the end of the document, " + found(),
           "a file holds one JSON value; is there a brace too many?");
    return root;
  } catch (SyntaxError& error) {
    report_syntax(error.position, std::move(error.message), std::move(error.suggestion));
    return of_kind(Value::Kind::broken);
  }
}

void Parser::skip_space() {
  for (; !at_end(); ++at_) {
    const char c = text_[at_];
    if (c == '\n') {
      ++line_;
    } else if (c == '/' || c == '#') {
      fail("comments are not part of JSON", "use the key \"$comment\"");
    } else if (c != ' ' && c != '\t' && c != '\r') {
      return;
    }
  }
}

Value Parser::of_kind(Value::Kind kind) const {
  Value result;
  result.kind = kind;
  result.line = line_;
  return result;
}

Value Parser::value() {
  if (++values_ > max_values)
    fail("the file holds more than 10 million values", "recorded data belong into a CSV file");
  if (at_end()) fail("a value is missing: the file ends here", "is the file complete?");
  const char c = peek();
  if (c == '{' || c == '[') {
    if (path_.size() >= static_cast<std::size_t>(max_depth))
      fail("nested deeper than 64 levels", "a study needs less than ten");
    return c == '{' ? object() : array();
  }
  if (c == '"') {
    Value result = of_kind(Value::Kind::text);
    const auto parts = std::make_shared<Parts>();
    result.parts = parts;
    parts->text = string();
    return result;
  }
  if (c == '-' || is_digit(c)) return number();
  if (is_word(c)) return word();
  if (c == '\'') fail("texts are written in double quotes");
  if (c == '+' || c == '.')
    fail("a number cannot begin with " + in_quotes(std::string_view(&c, 1)),
         "write 0.5, not .5 or +0.5");
  fail("a value is missing, " + found(), c == ']' || c == '}' ? "is there a comma too many?" : "");
}

Value Parser::object() {
  Value result = of_kind(Value::Kind::object);
  const auto parts = std::make_shared<Parts>();
  result.parts = parts;
  std::unordered_set<std::string> seen;
  ++at_;
  skip_space();
  if (take('}')) return result;
  path_.emplace_back();
  for (;;) {
    if (next_is('}')) fail("a key is missing, found \"}\"", "remove the comma before it");
    if (!next_is('"'))
      fail("a key in double quotes is missing, " + found(), "keys are texts: \"key\": value");
    const int key_line = line_;
    std::string key = string();
    path_.back().key = key;
    skip_space();
    if (!take(':')) fail("a colon is missing after the key " + in_quotes(key) + ", " + found());
    skip_space();
    Value member = value();
    if (seen.insert(key).second) {
      parts->keys.push_back(std::move(key));
      parts->items.push_back(std::move(member));
    } else {
      problems_.add(
          pointer(), key_line,
          "the key is repeated (first on line " + std::to_string(result.find(key)->line) + ")",
          "remove one of the two");
    }
    skip_space();
    if (take('}')) break;
    if (!take(','))
      fail("\",\" or \"}\" is missing, " + found(), at_end() ? "is the file complete?" : "");
    skip_space();
  }
  path_.pop_back();
  return result;
}

Value Parser::array() {
  Value result = of_kind(Value::Kind::array);
  const auto parts = std::make_shared<Parts>();
  result.parts = parts;
  ++at_;
  skip_space();
  if (take(']')) return result;
  path_.emplace_back().in_array = true;
  for (;;) {
    path_.back().index = parts->items.size();
    if (next_is(']')) fail("a value is missing, found \"]\"", "remove the comma before it");
    parts->items.push_back(value());
    skip_space();
    if (take(']')) break;
    if (!take(','))
      fail("\",\" or \"]\" is missing, " + found(), at_end() ? "is the file complete?" : "");
    skip_space();
  }
  path_.pop_back();
  return result;
}

Value Parser::broken_number(std::string message, std::string suggestion) {
  problems_.add(pointer(), line_, std::move(message), std::move(suggestion));
  return of_kind(Value::Kind::broken);
}

Value Parser::word() {
  const std::size_t begin = at_;
  while (is_word(peek())) ++at_;
  const std::string_view name = text_.substr(begin, at_ - begin);
  if (name == "true" || name == "false") {
    Value result = of_kind(Value::Kind::boolean);
    result.flag = name == "true";
    return result;
  }
  if (name == "null") return of_kind(Value::Kind::null);
  for (const std::string_view infinite :
       {"NaN", "nan", "NAN", "Infinity", "infinity", "inf", "Inf", "INF"}) {
    if (name != infinite) continue;
    return broken_number(
        std::string(name) + " is not a number",
        "numbers are finite; only bounds of a box may be free: \"-inf\" and \"inf\" in quotes");
  }
  fail_at(begin, "unknown word " + in_quotes(name),
          "texts are written in double quotes; the words of JSON are true, false and null");
}

Value Parser::number() {
  const std::size_t begin = at_;
  const auto digits = [&](const char* where) {
    if (!is_digit(peek())) fail(std::string("a digit is missing ") + where + ", " + found());
    while (is_digit(peek())) ++at_;
  };
  if (take('-') && is_word(peek())) {
    Value infinite = word();
    if (infinite.kind != Value::Kind::broken) fail_at(begin, "a digit is missing after the sign");
    return infinite;
  }
  const std::size_t first = at_;
  digits("in a number");
  if (text_[first] == '0' && at_ > first + 1)
    fail_at(first, "a number begins with a superfluous 0", "write 7, not 07");
  if (take('.')) digits("after the decimal point");
  if (take('e') || take('E')) {
    if (!take('+')) take('-');
    digits("in the exponent");
  }
  Value result = of_kind(Value::Kind::number);
  const auto [end, code] = std::from_chars(text_.data() + begin, text_.data() + at_, result.number);
  if (code != std::errc() || end != text_.data() + at_) {
    return broken_number(
        in_quotes(text_.substr(begin, at_ - begin)) + " is beyond the range of double numbers",
        "about 1e-308 to 1.8e308, or 0");
  }
  return result;
}

unsigned Parser::hex4() {
  unsigned code = 0;
  const char* begin = text_.data() + at_;
  const char* end = text_.data() + std::min(at_ + 4, text_.size());
  if (std::from_chars(begin, end, code, 16).ptr - begin != 4)
    fail("\\u needs four hexadecimal digits");
  at_ += 4;
  return code;
}

void Parser::escape(std::string& out) {
  static constexpr std::string_view names = "\"\\/bfnrt", bytes = "\"\\/\b\f\n\r\t";
  const std::size_t begin = at_ - 1;
  if (const std::size_t i = at_end() ? std::string_view::npos : names.find(peek());
      i != std::string_view::npos) {
    ++at_;
    out += bytes[i];
    return;
  }
  if (!take('u')) fail_at(begin, "unknown escape sequence in a text", "write \\\\ for a backslash");
  unsigned code = hex4();
  if (code >= 0xD800 && code <= 0xDFFF) {
    const bool pair = code <= 0xDBFF && text_.substr(at_, 2) == "\\u";
    if (pair) at_ += 2;
    const unsigned low = pair ? hex4() : 0;
    if (low < 0xDC00 || low > 0xDFFF)
      fail_at(begin, "half of a surrogate pair in a text", "write the character itself");
    code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
  }
  const auto tail = [&](int shift) { out += static_cast<char>(0x80 | ((code >> shift) & 0x3F)); };
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xC0 | (code >> 6));
    tail(0);
  } else if (code < 0x10000) {
    out += static_cast<char>(0xE0 | (code >> 12));
    tail(6), tail(0);
  } else {
    out += static_cast<char>(0xF0 | (code >> 18));
    tail(12), tail(6), tail(0);
  }
}

std::string Parser::string() {
  const std::size_t begin = at_++;
  std::string result;
  for (;;) {
    if (at_end()) fail_at(begin, "a text without its closing quote");
    const char c = text_[at_++];
    if (c == '"') return result;
    if (c == '\n')
      fail_at(begin, "a text without its closing quote on the line", "write a line break as \\n");
    if (static_cast<unsigned char>(c) < 0x20)
      fail_at(at_ - 1, "a control character in a text", "write it as \\u00..");
    if (c == '\\') {
      escape(result);
    } else {
      result += c;
    }
  }
}

}  // namespace

Value parse(std::string_view text, Problems& problems) { return Parser(text, problems).document(); }

}  // namespace cordon::json
