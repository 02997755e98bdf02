// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "cordon/interfaces/model.hpp"
#include "cordon/solvers/polytope.hpp"

namespace cordon::conformance {

/// The states at the time of sample `at` that model and samples allow, in rational arithmetic:
/// those that earlier samples and this one lead to, of which the later ones have successors.
/// Nothing where the model has E or intervals, where a number of the data would have to be rounded,
/// or where polyhedra grow too large.
std::optional<Polytope> feasible_states(const Model& model, const LineForm& X0,
                                        const std::vector<Sample>& samples, std::size_t at);

/// The successors of the states of X that the sample of their time allows, as far as the sample of
/// the next time allows them; as above.
std::optional<Polytope> feasible_successors(const Model& model, const LineForm& X,
                                            const Sample& before, const Sample& now);

}  // namespace cordon::conformance
