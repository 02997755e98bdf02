// SPDX-License-Identifier: GPL-3.0-or-later
// The words of a formula.
#pragma once

#include <string>
#include <string_view>

#include "cordon/formulas/parse.hpp"

namespace cordon::formulas {

struct Token {
  enum class Kind { number, name, symbol, end };
  Kind kind = Kind::end;
  std::string_view text;
  double value = 0;          ///< of a number
  std::size_t position = 0;  ///< in bytes

  bool is(char symbol) const { return kind == Kind::symbol && text[0] == symbol; }
};

/// Where the text is no formula; caught by `parse`.
struct NoFormula {
  FormulaError error;
};

/// Reads one token after the other.
class Tokens {
 public:
  explicit Tokens(std::string_view text) : text_(text) {}

  /// Throws NoFormula for what is no token.
  Token next();
  /// Of a byte, in characters from 1.
  int column(std::size_t position) const;

 private:
  Token number();
  [[noreturn]] void fail(std::size_t position, std::string message, std::string suggestion = "");
  [[noreturn]] void refuse_symbol();

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace cordon::formulas
