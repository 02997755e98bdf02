// SPDX-License-Identifier: GPL-3.0-or-later
// Observer for descriptor systems on backends with exact intersections [Rego2025, sec. 4], in the
// coordinates of static_rows.hpp, z = T⁻¹ x = (z̃, ž):
//   Z̄_k = {([Ã z + B̃ u + B̃w w]; ž) : z ∈ Ẑ_{k-1}, w ∈ W, ž ∈ R^{n-n_z}} cut by the static rows with
//   a second copy of W, then by the measurement.
// ž is free with lines; without, it is taken from an admissible set X_A that holds x_k for all k.
// Exact if no generator of W enters both B̃w and B̌w, and the static rows of k = 0 are included; else
// the two copies of W, or the larger start, make the recursion an outer one, and the estimate says
// so.
//
// Ranges of effectiveness: effectiveness.hpp. An input with a range that enters dynamic rows,
// static rows or outputs alike has its factor taken once for each, which makes the recursion an
// outer one.
//
// Coordinates that are rounded, where the backend rounds outward and is taken at its word: each
// number M_ij of the form is known up to u |M_ij|, which makes the recursion an outer one. With an
// admissible set, equations get boxes u |M| |z| of room, the dynamic ones u |Φ| |ž| besides, and
// outputs are taken as C x. Without, ž has no bound: states keep their coordinates, X_k is {x : Ẽ x
// ∈ Ã X_{k-1} ⊕ …} with rows of the model, and static rows that were rounded come after the
// outputs; one that still holds a state without a bound says nothing.
//
// Interval matrices A and B add a box to every equation, of the size that effectiveness.hpp tells
// for the states before: to the dynamic rows that of the last estimate, to the static rows that of
// the predicted set. A static row that holds a state without a bound says nothing then. C may be an
// interval matrix.
#pragma once

#include <memory>

#include "cordon/registry/plugin.hpp"

namespace cordon::estimators {

std::unique_ptr<Observer> semi_explicit_observer(const ObserverContext& context,
                                                 const Params& params);

}  // namespace cordon::estimators
