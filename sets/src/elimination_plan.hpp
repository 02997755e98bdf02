// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <vector>

#include "cordon/sets/constraint_elimination.hpp"
#include "residue.hpp"

namespace cordon::sets {

/// One step of `eliminate_constraints`, by the places of row and factor in X. Each is an enclosure
/// whatever row and factor it names, so that the steps can be repeated in another arithmetic.
struct EliminationStep {
  enum Kind {
    drop,          ///< forget the row
    clear_column,  ///< subtract multiples of the row from the others, so that the factor is left in
                   ///< it alone
    eliminate      ///< solve the row for the factor, put it in everywhere, forget both
  };
  Kind kind;
  Index row, col;
};

/// The steps that `eliminate_constraints` takes, but for the rescaling of factors. X has no lines.
std::vector<EliminationStep> plan_elimination(const LineForm& X, Index max_constraints,
                                              const ConstraintElimination& options);

/// `eliminate_constraints` of a set that was computed itself, from terms of these sizes.
Reduced eliminate_constraints(const LineForm& X, const Terms& before, Index max_constraints,
                              const ConstraintElimination& options);

/// Constraints of a set of dimension n whose lifted generators are reduced to so many: a reduction
/// needs two for each row of [G; A]. A few rows are worth more than that, where there is room for
/// them at all.
inline Index most_constraints(Index n, Index max_generators) {
  constexpr Index few = 3;
  return std::max(max_generators / 2 - n, std::min(few, max_generators - n));
}

}  // namespace cordon::sets
