// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cordon/formulas/expression.hpp"
#include "cordon/interfaces/plant.hpp"

namespace cordon {

/// What the formulas of a plant are made of: expressions of one graph, which outlives them, in the
/// coordinates and units of `Plant::next`.
struct PlantVariables {
  std::vector<formulas::Expression> x;  ///< one per state
  std::vector<formulas::Expression> u;  ///< one per input, known numbers at each step
  formulas::Expression k;               ///< the number of the step
};

/// A plant as formulas, in the graph of its variables: nodes that are equal are one. Where the
/// numbers of the plant are NaN, a formula should not be defined. `Plant::as_formulas` says what is
/// checked.
struct PlantFormulas {
  std::vector<formulas::Expression> next;    ///< x⁺, one per state
  std::vector<formulas::Expression> output;  ///< y, one per output
};

}  // namespace cordon
