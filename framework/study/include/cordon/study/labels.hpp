// SPDX-License-Identifier: GPL-3.0-or-later
// What people call the numbers of a system: names with units, and the time of a step.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cordon/core/types.hpp"

namespace cordon {

/// Names of coordinates, such as "level [m]": the unit in brackets at the end, if there is one. A
/// list is empty, or names every coordinate; no two coordinates of a list are called alike. Nothing
/// is computed from them.
struct Labels {
  using Names = std::vector<std::string>;

  Names states, inputs, outputs, disturbances, noises, faults;
  double sampling_time = 0;  ///< seconds from k to k + 1, > 0; 0: not known

  /// Is there any name?
  bool any() const;
};

/// "level [m]", or "x_2" where coordinate i (from 0) of `symbol` "x" has no name.
std::string label_of(const Labels::Names& names, const std::string& symbol, Index i);

/// "m" of "level [m]"; empty: it has no unit.
std::string unit_of(const std::string& name);

/// Head of a column: "x_2", and the name behind it where there is one, "x_2 level [m]". What stands
/// before the first space does not depend on names.
std::string heading_of(const Labels::Names& names, const std::string& symbol, Index i);

/// "k = 12", and "k = 12 (6 s)" where the time of a step is known.
std::string time_text(const Labels& labels, std::int64_t k);

}  // namespace cordon
