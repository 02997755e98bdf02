// SPDX-License-Identifier: GPL-3.0-or-later
// What is varied, and what is held meanwhile.
#pragma once

#include <string>
#include <vector>

#include "random_set.hpp"

namespace cordon::bench {

/// One quantity that grows from case to case.
struct Axis {
  std::string name;    ///< "states", …
  std::string symbol;  ///< "n", "g", "m"
  std::string held;    ///< what the other sizes are meanwhile
  Index Size::*varied;
  std::vector<Size> cases;  ///< states and both budgets
  bool hull = false;        ///< is the certified hull timed too?

  double at(const Size& size) const { return static_cast<double>(size.*varied); }
};

inline std::vector<Axis> all_axes() {
  Axis states{"states", "n", "generators 10 n, constraints n/2, outputs n/2", &Size::n, {}, true};
  for (const Index n : {2, 4, 8, 16, 32, 64, 100}) states.cases.push_back({n, 10 * n, n / 2});
  Axis generators{"generators", "g", "4 states, 5 constraints, 2 outputs", &Size::g, {}};
  for (Index g = 20; g <= 1280; g *= 2) generators.cases.push_back({4, g, 5});
  Axis constraints{"constraints", "m", "4 states, 80 generators, 2 outputs", &Size::m, {}};
  for (Index m = 1; m <= 32; m *= 2) constraints.cases.push_back({4, 80, m});
  return {states, generators, constraints};
}

inline const std::vector<std::string>& all_backends() {
  static const std::vector<std::string> names{"interval", "zonotope", "constrained_zonotope",
                                              "line_zonotope"};
  return names;
}

}  // namespace cordon::bench
