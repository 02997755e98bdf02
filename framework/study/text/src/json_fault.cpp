// SPDX-License-Identifier: GPL-3.0-or-later
#include "json_fault.hpp"

#include <algorithm>
#include <charconv>

#include "study/text/json_text.hpp"

namespace cordon::json {

namespace {

bool is_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// Goes through what comes next until something is wrong, and throws it.
class FaultFinder {
 public:
  FaultFinder(std::string_view text, std::size_t at) : text_(text), at_(at) {}

  void next(Last last, std::string_view key);
  /// Not among the known faults.
  [[noreturn]] void fail_anyhow() const { fail("this is not JSON, " + found()); }

 private:
  void end_of_token();
  void skip_space();
  void comma_or(char closing);
  void key();
  void value();
  void number();
  void word();
  void text();
  void escape();
  unsigned hex4();
  std::string found() const;

  char peek() const { return at_end() ? '\0' : text_[at_]; }
  bool at_end() const { return at_ >= text_.size(); }
  bool take(char c) { return !at_end() && text_[at_] == c && ++at_ > 0; }
  [[noreturn]] void fail(std::string message, std::string suggestion = "") const {
    fail_at(at_, std::move(message), std::move(suggestion));
  }
  [[noreturn]] void fail_at(std::size_t position, std::string message,
                            std::string suggestion = "") const {
    throw Fault{position, std::move(message), std::move(suggestion), of_};
  }

  std::string_view text_;
  std::size_t at_;
  Fault::Of of_ = Fault::Of::latest;
};

void FaultFinder::next(Last last, std::string_view latest_key) {
  end_of_token();
  const bool opened = last == Last::opened_array || last == Last::opened_object;
  of_ = opened ? Fault::Of::container : Fault::Of::latest;
  skip_space();
  if (opened) of_ = Fault::Of::next;
  switch (last) {
    case Last::nothing:
    case Last::opened_array:
      return value();
    case Last::root:
      fail("more text after the end of the document, " + found(),
           "a file holds one JSON value; is there a brace too many?");
    case Last::opened_object:
      return key();
    case Last::key:
      if (!take(':'))
        fail("a colon is missing after the key " + in_quotes(latest_key) + ", " + found());
      skip_space();
      return value();
    case Last::element:
      comma_or(']');
      if (peek() == ']') fail("a value is missing, found \"]\"", "remove the comma before it");
      return value();
    case Last::member:
      comma_or('}');
      if (peek() == '}') fail("a key is missing, found \"}\"", "remove the comma before it");
      return key();
  }
}

/// What came last may be the beginning of a longer word: the library finds true in "truely".
void FaultFinder::end_of_token() {
  if (at_ == 0 || !is_word(text_[at_ - 1]) || !is_word(peek())) return;
  while (at_ > 0 && is_word(text_[at_ - 1])) --at_;
  word();
}

void FaultFinder::skip_space() {
  while (!at_end() && is_space(peek())) ++at_;
  if (peek() == '/' || peek() == '#')
    fail("comments are not part of JSON", "use the key \"$comment\"");
}

void FaultFinder::comma_or(char closing) {
  if (!take(',')) {
    fail(std::string("\",\" or \"") + closing + "\" is missing, " + found(),
         at_end() ? "is the file complete?" : "");
  }
  skip_space();
  of_ = Fault::Of::next;
}

std::string FaultFinder::found() const {
  if (at_end()) return "the file ends here";
  std::size_t end = at_ + 1;
  while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0u) == 0x80u)
    ++end;  // a whole character
  if (is_word(peek())) end = at_ + word_at(text_, at_).size();
  return "found " +
         (peek() == '"' ? std::string("a text") : in_quotes(text_.substr(at_, end - at_)));
}

void FaultFinder::key() {
  if (is_digit(peek()) && at_ >= 2 && text_[at_ - 1] == ',' && is_digit(text_[at_ - 2]))
    fail("a key is missing, " + found(), "a decimal comma? Write 0.5, not 0,5");
  if (peek() != '"')
    fail("a key in double quotes is missing, " + found(), "keys are texts: \"key\": value");
  text();
}

void FaultFinder::value() {
  if (at_end()) fail("a value is missing: the file ends here", "is the file complete?");
  const char c = peek();
  if (c == '"') return text();
  if (c == '-' || is_digit(c)) return number();
  if (is_word(c)) return word();
  if (c == '\'') fail("texts are written in double quotes");
  if (c == '+' || c == '.')
    fail("a number cannot begin with " + in_quotes(std::string_view(&c, 1)),
         "write 0.5, not .5 or +0.5");
  constexpr std::string_view minus_sign = "\u2212";
  if (text_.substr(at_, minus_sign.size()) == minus_sign)
    fail("a value is missing, " + found(), "write the minus sign as -");
  fail("a value is missing, " + found(), c == ']' || c == '}' ? "is there a comma too many?" : "");
}

void FaultFinder::number() {
  const std::size_t begin = at_;
  const auto digits = [&](const char* where) {
    if (!is_digit(peek())) fail(std::string("a digit is missing ") + where + ", " + found());
    while (is_digit(peek())) ++at_;
  };
  if (take('-') && is_word(peek())) {
    word();
    fail_at(begin, "a digit is missing after the sign");
  }
  digits("in a number");
  if (take('.')) digits("after the decimal point");
  if (take('e') || take('E')) {
    if (!take('+')) take('-');
    digits("in the exponent");
  }
}

void FaultFinder::word() {
  const std::string_view name = word_at(text_, at_);
  if (name == "true" || name == "false" || name == "null") return;
  fail("unknown word " + in_quotes(name),
       "texts are written in double quotes; the words of JSON are true, false and null");
}

void FaultFinder::text() {
  const std::size_t begin = at_++;
  while (!take('"')) {
    if (at_end()) fail_at(begin, "a text without its closing quote");
    const char c = peek();
    if (c == '\n')
      fail_at(begin, "a text without its closing quote on the line", "write a line break as \\n");
    if (static_cast<unsigned char>(c) < 0x20)
      fail("a control character in a text", "write it as \\u00..");
    ++at_;
    if (c == '\\') escape();
  }
}

void FaultFinder::escape() {
  const std::size_t begin = at_ - 1;
  if (!at_end() && std::string_view("\"\\/bfnrt").find(peek()) != std::string_view::npos) {
    ++at_;
    return;
  }
  if (!take('u')) fail_at(begin, "unknown escape sequence in a text", "write \\\\ for a backslash");
  const unsigned code = hex4();
  if (code < 0xD800 || code > 0xDFFF) return;
  const bool pair = code <= 0xDBFF && text_.substr(at_, 2) == "\\u";
  if (pair) at_ += 2;
  const unsigned low = pair ? hex4() : 0;
  if (low < 0xDC00 || low > 0xDFFF)
    fail_at(begin, "half of a surrogate pair in a text", "write the character itself");
}

unsigned FaultFinder::hex4() {
  unsigned code = 0;
  const char* begin = text_.data() + at_;
  const char* end = text_.data() + std::min(at_ + 4, text_.size());
  if (std::from_chars(begin, end, code, 16).ptr - begin != 4)
    fail("\\u needs four hexadecimal digits");
  at_ += 4;
  return code;
}

}  // namespace

Fault fault_of(std::string_view text, std::size_t at, Last last, std::string_view key) {
  FaultFinder finder(text, at);
  try {
    finder.next(last, key);
    finder.fail_anyhow();
  } catch (Fault& fault) {
    return std::move(fault);
  }
}

std::string_view word_at(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && is_word(text[end])) ++end;
  return text.substr(at, end - at);
}

}  // namespace cordon::json
