// SPDX-License-Identifier: GPL-3.0-or-later
// Set operations with outward rounding: for the operands' stored numbers and exact real arithmetic,
// the exact result is a subset of the set that the returned numbers stand for.
//
// Errors of one operation are bounded by error-free transformations and merged: one axis-parallel
// generator per coordinate, one slack column per row of constraints, none where nothing was rounded
// (`exact` then). A line is unbounded, so that no radius covers an error in its column: where a
// product with M would round, x itself becomes a line y with the rows y - Mδ - Gξ = c, and the
// product is that with the unit matrix. Shapes, degenerate cases and errors are those of the
// nominal functions of the same names; Errc::not_finite after an overflow. Complexity: that of the
// nominal functions, with a larger constant. Source: [Ogita2005] for the transformations.
#pragma once

#include <optional>
#include <span>

#include "cordon/core/interval_matrix.hpp"
#include "cordon/sets/line_zonotope.hpp"
#include "cordon/sets/strip.hpp"
#include "cordon/sets/zonotope.hpp"

namespace cordon::sets::outward {

/// A X ⊕ {f} ⊕ Σ Tᵢ Sᵢ.
Reduced affine_sum(const LineZonotope& X, MatrixIn A, VectorIn f,
                   std::span<const Summand> summands);

/// {x ∈ X : z - C x ∈ T V}.
Reduced strip_intersection(const LineZonotope& X, MatrixIn C, VectorIn z, MatrixIn T,
                           const LineZonotope& V);

/// {x ∈ X : R x ∈ Y}.
Reduced intersection(const LineZonotope& X, MatrixIn R, const LineZonotope& Y);

/// Closure of conv(X ∪ Y); `exact` for sets without lines if nothing was rounded.
Reduced convex_hull(const LineZonotope& X, const LineZonotope& Y);

/// Encloses {A x : A ∈ [A], x ∈ X}, where `hull` is a box around X, not empty, that is bounded
/// where rad(A) is not zero.
Reduced interval_map(const LineZonotope& X, const IntervalMatrix& A, const Box& hull);

/// X without the lines that its constraints determine: they are bounded exactly (`bound_lines`),
/// then their rows are solved for them.
Reduced enclose_without_lines(const LineZonotope& X);

/// Encloses X by a set without lines that rows determine, of at most `max_generators` and
/// `max_constraints`. The eliminations are those that the nominal functions propose, carried out
/// with radii; columns of rounding errors are merged before others are reduced. Rows with lines
/// that are left are forgotten where the budget asks for it. X itself (exact) if it fits and has no
/// lines. Needs max_generators ≥ n.
Reduced reduce(const LineZonotope& X, Index max_generators, Index max_constraints,
               const LineReduction& how = {});

/// Encloses X (lines are left alone) by a set with at most `max_constraints` rows.
Reduced eliminate_constraints(const LineZonotope& X, Index max_constraints,
                              const ConstraintElimination& options = {});

/// H with at most `max_generators` columns and {Gξ} ⊆ {Hη}. Columns that the nominal method leaves
/// stay as they are; those W that it replaces are enclosed by a parallelotope of basis F with |F⁻¹
/// W| 1 ≤ 1, proven by an approximate inverse of F; if the proof fails, by a box.
Matrix reduce_generators(MatrixIn G, Index max_generators,
                         GeneratorReduction method = GeneratorReduction::adaptive);

/// A zonotope around {x ∈ Z : z - C x ∈ T V}: for λ as the nominal method chooses it, Z(λ) with its
/// rounding errors. Nothing if the intersection is proven empty.
std::optional<Zonotope> correct(const Zonotope& Z, MatrixIn C, VectorIn z, MatrixIn T,
                                const Zonotope& V, StripMethod method = StripMethod::box);

/// A zonotope around conv(X ∪ Y).
Zonotope convex_hull(const Zonotope& X, const Zonotope& Y);

}  // namespace cordon::sets::outward
