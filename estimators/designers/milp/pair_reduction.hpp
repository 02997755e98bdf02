// SPDX-License-Identifier: GPL-3.0-or-later
// Enclosures of a pair of modes with fewer rows and generators, so that its program stays small.
#pragma once

#include <optional>

#include "designers/separation_problem.hpp"

namespace cordon::designers {

/// Does an input of U change N u, beyond rounding?
bool inputs_enter(const PairProgram& pair, const InputSequences& U);

/// (G', c', N') with κ'(u) ≤ κ(u) for all u ∈ U, and at most `max_generators` generators.
/// [Rego2025, sec. 5.2]
///
/// With R and L the range and left null space of N over the affine hull of U, the inputs that do
/// not separate are those with R N u in the constrained zonotope {Rc + RGξ : LGξ = L(Nu - c), ‖ξ‖∞
/// ≤ 1}, in r = rank N dimensions, whose rows are the same for all of U. This set is made smaller
/// in its description, never what u enters [Rego2025, Remark 7]: constraints are eliminated down to
/// some numbers up to `max_constraints`, generators of what is left are reduced by each method, and
/// of these sets the one is taken that is the least widened in sampled directions. Where generators
/// do not span the rows, small ones are added, so that κ' is finite. Nothing: no input enters, or r
/// > max_generators.
std::optional<PairProgram> reduce_pair(const PairProgram& pair, const InputSequences& U,
                                       Index max_generators, Index max_constraints);

}  // namespace cordon::designers
