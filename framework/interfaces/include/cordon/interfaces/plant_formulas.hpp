// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cordon/formulas/expression.hpp"
#include "cordon/interfaces/plant.hpp"

namespace cordon {

/// What the formulas of a plant are made of: expressions of one graph.
struct PlantVariables {
  std::vector<formulas::Expression> x, u;
  formulas::Expression k;  ///< the number of the step
};

/// A plant as formulas, in the graph of its variables.
struct PlantFormulas {
  std::vector<formulas::Expression> next;    ///< x⁺, one per state
  std::vector<formulas::Expression> output;  ///< y, one per output
};

}  // namespace cordon
