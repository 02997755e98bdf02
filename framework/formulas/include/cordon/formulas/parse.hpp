// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas as text.
//
//   sum      = product { ("+" | "-") product }
//   product  = sign { ("*" | "/") sign }
//   sign     = "-" sign | power
//   power    = atom [ "^" sign ]                        right associative: -x^2 = -(x^2), 2^-1
//   atom     = number | name | name "(" sum { "," sum } ")" | "(" sum ")"
//
// Numbers are decimal and stand for the nearest doubles, `pi` for the interval of the two doubles
// around it. An exponent that is constant and an integer of at most 64 in magnitude is an integer
// power, another constant a real power of a base ≥ 0, and any other exponent b means exp(b log a).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cordon/formulas/expression.hpp"

namespace cordon::formulas {

inline constexpr std::size_t longest_formula = 10'000;  ///< characters
inline constexpr int deepest_formula = 200;             ///< parentheses, calls, signs and exponents

/// What is wrong with a formula.
struct FormulaError {
  int column = 0;  ///< of the character, from 1; 0: the formula as a whole
  std::string message;
  std::string suggestion = {};  ///< may be empty
};

/// The names that a formula may use besides functions and `pi`.
struct Vocabulary {
  std::map<std::string, Expression, std::less<>> known;
  /// Names that mean something elsewhere, with the reason why they do not here.
  std::map<std::string, std::string, std::less<>> refused;
};

/// Is it a letter, then letters, digits and _, and neither a function nor `pi` or `k`? Otherwise
/// the reason, "" if it is.
std::string why_no_name(std::string_view name);

/// The formula in the graph of the vocabulary's expressions; nothing if there are errors, which are
/// added: all unknown names and undefined constants, and the first place where the text is no
/// formula. Any bytes are taken. O(length).
std::optional<Expression> parse(std::string_view text, Graph& graph, const Vocabulary& vocabulary,
                                std::vector<FormulaError>& errors);

}  // namespace cordon::formulas
