// SPDX-License-Identifier: GPL-3.0-or-later
// Linear models that are proven to enclose formulas on a region.
#pragma once

#include <vector>

#include "cordon/core/interval.hpp"
#include "cordon/interfaces/model.hpp"

namespace cordon {

/// How much of a row the linear model leaves out.
struct LinearisedRow {
  Interval remainder;  ///< contains F_row(z) - slope · z for all z of the region
  Interval attained;   ///< values that it takes at points: no bounds are narrower
};

/// A linear model with its bounds, and what they cost.
struct Linearised {
  Model model;
  std::vector<LinearisedRow> f, g;
  /// The coordinates of W and V behind those of the formulas are errors of these rows.
  std::vector<Index> in_W, in_V;
};

/// A linear model of a system by formulas: for all (x, u) ∈ region, w ∈ W, v ∈ V
///   f(x, w, u) ∈ A x + B u + Bw (w, e),   g(x, v, u) ∈ C x + D u + Dv (v, d),
///   W' = W × E,  V' = V × D,
/// A, B and the first columns of Bw the Jacobian of f at the centre of region × hull W, E a box of
/// f(x, w, u) - A x - B u - Bw w over it, with a column of the identity for each of its
/// coordinates; g likewise. Where the same nonlinear term stands in several rows, their errors
/// follow one of them: what the others add to a multiple of it is bounded then, which makes E a
/// parallelotope. It holds the constants, too, and is bounded by branch and bound: its coordinates
/// come within a thousandth of the smallest ones where 1,000 parts of the region do, or fewer of
/// long formulas. Bounds are outward, for the doubles that A, B, … are.
///
/// Invariants and the admissible set of the formulas are left out. Throws Errc::dimension,
/// Errc::unsupported for formulas of the time k and unbounded regions, W or V,
/// Errc::not_enclosed where a formula is not defined on the whole region.
///
/// `given`: its A, B, C and D are taken in place of derivatives, those of a published model for
/// example.
Linearised linearise(const Model& model, const Box& states, const Box& inputs,
                     const LinearModel* given = nullptr);

}  // namespace cordon
