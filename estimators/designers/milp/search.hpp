// SPDX-License-Identifier: GPL-3.0-or-later
// The mixed-integer designer: the program (37) of [Rego2025] after the reduction of the pairs,
// solved by GLPK.
#pragma once

#include "designers/separation_problem.hpp"

namespace cordon::designers {

struct MilpLimits {
  Index max_generators = 8;   ///< per pair, those of the inputs not counted
  Index max_constraints = 2;  ///< per pair, before generators are reduced
  double gap = 1e-6;          ///< relative
  double time_limit = 60;     ///< seconds
};

/// Every pair is enclosed by one with fewer generators, for every input (reductions never touch
/// what the inputs enter), so that what separates the enclosures separates the pairs. The optimum
/// of that program is an upper bound of the problem's.
SearchResult search_milp(const SeparationProblem& problem, const MilpLimits& limits,
                         DesignControl& control);

}  // namespace cordon::designers
