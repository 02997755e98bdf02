// SPDX-License-Identifier: GPL-3.0-or-later
// Some input that separates, at little expense: what there is to show when the search over facets
// does not come to its end.
#pragma once

#include <functional>

#include "designers/facets/node_program.hpp"
#include "designers/known_answer.hpp"

namespace cordon::designers {

/// Along the ways from the cheapest input of all to the ends of U in a few directions (an input all
/// the time, alternating, at one time only, and some by chance), the nearest that separates, by
/// halving: κ is convex, so that whatever lies behind an input that separates a pair does so too,
/// if the cheapest does not.
KnownAnswer first_input(const SeparationProblem& problem, NodeProgram& program,
                        const std::function<bool()>& over);

}  // namespace cordon::designers
