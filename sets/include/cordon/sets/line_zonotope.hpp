// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "cordon/core/line_form.hpp"
#include "cordon/sets/constraint_elimination.hpp"
#include "cordon/sets/generator_reduction.hpp"

namespace cordon::sets {

/// The line zonotope {c + Mδ + Gξ : ‖ξ‖∞ ≤ 1, Sδ + Aξ = b} is the exchange form itself. Maps, sums,
/// products, generalised intersections and convex hulls are in core/line_form.hpp, line elimination
/// in core/line_elimination.hpp, questions (support, hull, emptiness, …) in
/// solvers/set_questions.hpp. Here: the two fused operations of an observer's step, and reduction.
using LineZonotope = LineForm;

/// The summand T·set.
struct Summand {
  MatrixIn T;
  const LineZonotope& set;
};

/// A X ⊕ {f} ⊕ Σ Tᵢ Sᵢ; exact, assembled without temporaries. A is m×n, Tᵢ is m×dim Sᵢ. A sum that
/// is flat gets a generator of `tolerances::product_noise` (1e-14) of the terms per coordinate:
/// errors of its plane would otherwise contradict exact measurements later. Where the images of
/// lines are dependent but for rounding (entries below `vague_column` (1e-4) of the terms they
/// cancelled from) and exact arithmetic tells that they are not, every coordinate that they may
/// still reach becomes unbounded: the sum then holds the exact one and is larger.
Reduced affine_sum(const LineZonotope& X, MatrixIn A, VectorIn f,
                   std::span<const Summand> summands);

/// {x ∈ X : z - C x ∈ T V}. Rows: those of X, those of V, then C M δ + C G ξ + T(M_V δ_V +
/// G_V ξ_V) = z - C c - T c_V. Of these last rows, those without lines are left out where they say
/// nothing beyond rounding (all of the row below `tolerances::product_noise` (1e-14) of its terms),
/// or are missed by less than `tolerances::proof_margin` (1e-10) of them: the set is larger then,
/// else it is `exact`. And where all rows together are so
/// nearly dependent that rounding matters, each gets a slack of `tolerances::product_noise` (1e-14)
/// of its terms.
Reduced strip_intersection(const LineZonotope& X, MatrixIn C, VectorIn z, MatrixIn T,
                           const LineZonotope& V);

/// How a line zonotope is reduced.
struct LineReduction {
  GeneratorReduction generators = GeneratorReduction::adaptive;
  ConstraintElimination constraints;
};

/// Encloses X by a set of at most `max_generators` and `max_constraints`: lines are eliminated
/// (exact), then constraints, then the generators of the lifted zonotope [G; A] are reduced. With
/// fewer than two of them for each of its n + constraints rows that would leave little more than a
/// parallelotope: more constraints are eliminated first. Needs max_generators ≥ n.
Reduced reduce(const LineZonotope& X, Index max_generators, Index max_constraints,
               const LineReduction& how = {});

}  // namespace cordon::sets
