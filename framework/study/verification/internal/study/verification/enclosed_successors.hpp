// SPDX-License-Identifier: GPL-3.0-or-later
// An outer description of a set's successors, in as few variables as an observer needs for them.
#pragma once

#include <optional>

#include "study/verification/feasible_set.hpp"

namespace cordon::verification {

/// A set whose operations were rounded: c and b are known up to `center` and `rows`, entry by
/// entry. `widened` has factors for these errors and holds the true set; the columns of one
/// roundoff that this takes are nothing for a solver, so that it bounds `set`.
struct Enclosure {
  LineForm set;
  Vector center, rows;
  LineForm widened;
};

/// Encloses `successors(model, X, admissible_set, transition)`. Inputs, outputs, disturbances and
/// noises are no variables here, so that bounds cost a tenth of those of the exact form. Nothing
/// where the rounding of a row has no bound: X, V, W or the admissible set have lines, or E is
/// singular in decimals only.
std::optional<Enclosure> enclosed_successors(const Model& model, const LineForm& X,
                                             const std::optional<LineForm>& admissible_set,
                                             const Transition& transition);

}  // namespace cordon::verification
