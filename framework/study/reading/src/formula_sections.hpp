// SPDX-License-Identifier: GPL-3.0-or-later
// What the names of a system by formulas stand for, and in which formulas they may stand.
#pragma once

#include <array>
#include <vector>

namespace cordon::json {

/// What a name stands for.
enum class Symbol { state, input, disturbance, noise, parameter };
struct SymbolWords {
  const char* key;   ///< of the list in the system
  const char* noun;  ///< for people
};
inline constexpr std::array<SymbolWords, 5> symbol_words{{{"states", "a state"},
                                                          {"inputs", "an input"},
                                                          {"disturbances", "a disturbance"},
                                                          {"noises", "a noise"},
                                                          {"parameters", "a parameter"}}};

/// The formulas of one key, and who may stand in them.
struct Section {
  const char* key;
  std::vector<Symbol> variables;  ///< in the order of the function's
  bool uses_time;
  const char* form;
};

inline const Section& section_f() {
  static const Section section{"f",
                               {Symbol::state, Symbol::disturbance, Symbol::input},
                               true,
                               "one formula per state: x at the next time"};
  return section;
}
inline const Section& section_g() {
  static const Section section{"g",
                               {Symbol::state, Symbol::noise, Symbol::input},
                               true,
                               "one formula per output, [\"x1 + v1\"] for example"};
  return section;
}
inline const Section& section_h() {
  static const Section section{
      "invariants", {Symbol::state}, false, "formulas that are 0 for the true state at all times"};
  return section;
}

}  // namespace cordon::json
