// SPDX-License-Identifier: GPL-3.0-or-later
// The cheapest separating input, with proof: the searches over cones and over facets together.
#pragma once

#include "designers/facets/search.hpp"

namespace cordon::designers {

/// First some input at little expense and `ConeSearch` for some thousands of nodes, which most
/// often ends with a proven optimum for sums of absolute inputs, however many there are. What it
/// leaves open goes to `search_facets`, which is best where pairs have few facets, whatever the
/// cost is, and sees equations of the input set and of tubes, for half of the time that is left;
/// then cones again for the rest. Each starts from what the others have found and proven.
SearchResult search_exactly(const SeparationProblem& problem, const FacetLimits& limits,
                            DesignControl& control);

}  // namespace cordon::designers
