// SPDX-License-Identifier: GPL-3.0-or-later
// What rounding leaves in nominal operations. Later operations see a result and no longer the terms
// that it was computed from: where these were much larger, errors would pass for statements about
// the set.
#pragma once

#include "cordon/core/line_form.hpp"
#include "cordon/sets/zonotope.hpp"

namespace cordon::sets {

/// Sizes of the terms that the rows [A b] and the coordinates [G c] of a set were computed from; 0:
/// not computed, hence exact.
struct Terms {
  Vector rows, state;
};
inline Terms no_terms(const LineForm& X) {
  return {Vector::Zero(X.constraints()), Vector::Zero(X.dim())};
}

/// `sizes` = |c| + |G| 1.
void take_reach(const Vector& c, const Matrix& G, Vector& sizes);

/// X, computed from such terms. Where the lifted zonotope [G; A] is so flat that the margin of
/// proofs does not cover `tolerances::product_noise` (1e-14) of the terms, these get factors of
/// their own: the set becomes larger by them.
LineForm with_residue(LineForm X, const Terms& terms);
/// Likewise of a zonotope whose coordinates were computed from terms of the sizes `state`.
Zonotope with_residue(Zonotope Z, const Vector& state);

}  // namespace cordon::sets
