// SPDX-License-Identifier: GPL-3.0-or-later
// The facet designer: exact search over the facets of the sets of inputs that do not separate.
#pragma once

#include "designers/known_answer.hpp"
#include "designers/separation_problem.hpp"

namespace cordon::designers {

struct FacetLimits {
  double gap = 1e-9;         ///< relative: the search ends when the cost is proven up to this share
  double time_limit = 60;    ///< seconds
  Index max_facets = 10000;  ///< per pair; a pair with more is left out of what bounds the cost
};

/// With R and L the range and left null space of N, the inputs that do not separate a pair are
/// those with RᵀN u in
///   Q = {RᵀGξ + Rᵀc : LᵀGξ = -Lᵀc, ‖ξ‖∞ ≤ 1 + ε}  in r = rank N dimensions,
/// so that separating means h·(RᵀN u) ≥ k for a facet (h, k) of Q. Best first: a node is the linear
/// program over U with the facets chosen so far; of the pairs that its input does not separate, the
/// one whose children cost most is branched on, a child per facet; the first node that violates
/// nothing is optimal. What children cost at least follows from the multipliers of their parent,
/// without a program, as far as possible; ties go to the pair with the fewest facets. All bounds
/// are proven by multipliers. A pair whose facets are not known is left out: the rest bounds the
/// cost, and an input that solves the rest is judged by the pair's own κ. What is known
/// before is the answer where the search finds nothing cheaper, or does not come to its end.
SearchResult search_facets(const SeparationProblem& problem, const FacetLimits& limits,
                           const KnownAnswer& known, DesignControl& control);

}  // namespace cordon::designers
