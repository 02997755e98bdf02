// SPDX-License-Identifier: GPL-3.0-or-later
#include "tokens.hpp"

#include <charconv>
#include <utility>

namespace cordon::formulas {

namespace {

// Of ASCII alone, whatever the locale.
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// Symbols that people type for those of formulas.
constexpr std::pair<std::string_view, std::string_view> meant[] = {
    {"**", "^ for powers"},
    {"−", "- for minus"},
    {"–", "- for minus"},
    {"·", "* for products"},
    {"×", "* for products"},
    {"÷", "/ for quotients"},
    {"²", "^2"},
    {"³", "^3"},
    {"√", "sqrt(…)"},
    {"π", "pi"},
    {"[", "parentheses ( )"},
    {"]", "parentheses ( )"},
    {"{", "parentheses ( )"},
    {"}", "parentheses ( )"},
};
constexpr std::string_view comparisons = "<>=!?&|%";

}  // namespace

int Tokens::column(std::size_t position) const {
  int column = 1;
  for (std::size_t i = 0; i < position && i < text_.size(); ++i)
    column += continues_character(text_[i]) ? 0 : 1;
  return column;
}

void Tokens::fail(std::size_t position, std::string message, std::string suggestion) {
  throw NoFormula{{column(position), std::move(message), std::move(suggestion)}};
}

void Tokens::refuse_symbol() {
  const std::string_view rest = text_.substr(at_);
  for (const auto& [written, instead] : meant)
    if (rest.starts_with(written))
      fail(at_, "\"" + std::string(written) + "\" is no symbol of formulas",
           "write " + std::string(instead));
  if (comparisons.find(rest[0]) != std::string_view::npos)
    fail(at_,
         "\"" + std::string(1, rest[0]) +
             "\": comparisons and conditions are not continuous, "
             "and nothing could be said between the points of a set",
         "abs, min and max are there");
  std::size_t length = 1;
  while (length < rest.size() && continues_character(rest[length])) ++length;
  fail(at_, "\"" + std::string(rest.substr(0, length)) + "\" is no symbol of formulas");
}

Token Tokens::number() {
  const std::size_t begin = at_;
  while (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.')) ++at_;
  if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
    std::size_t end = at_ + 1;
    if (end < text_.size() && (text_[end] == '+' || text_[end] == '-')) ++end;
    if (end < text_.size() && is_digit(text_[end])) {
      while (end < text_.size() && is_digit(text_[end])) ++end;
      at_ = end;
    }
  }
  Token token{Token::Kind::number, text_.substr(begin, at_ - begin), 0, begin};
  const auto [end, problem] =
      std::from_chars(token.text.data(), token.text.data() + token.text.size(), token.value);
  const std::string shown(token.text.substr(0, 40));
  if (problem == std::errc::result_out_of_range)
    fail(begin, shown + " is no double: its magnitude is too large or too small");
  if (problem != std::errc() || end != token.text.data() + token.text.size())
    fail(begin, "\"" + shown + "\" is no number");
  if (at_ < text_.size() && is_letter(text_[at_]))
    fail(at_, "a name stands directly behind the number " + shown, "write * between them");
  return token;
}

Token Tokens::next() {
  while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n'))
    ++at_;
  if (at_ == text_.size()) return {Token::Kind::end, {}, 0, at_};
  const char c = text_[at_];
  if (is_digit(c) || c == '.') return number();
  const std::size_t begin = at_;
  if (is_letter(c)) {
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    return {Token::Kind::name, text_.substr(begin, at_ - begin), 0, begin};
  }
  const bool is_known = std::string_view("+-*/^(),").find(c) != std::string_view::npos;
  if (!is_known || text_.substr(at_).starts_with("**")) refuse_symbol();
  ++at_;
  return {Token::Kind::symbol, text_.substr(begin, 1), 0, begin};
}

}  // namespace cordon::formulas
