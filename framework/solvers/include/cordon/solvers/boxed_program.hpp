// SPDX-License-Identifier: GPL-3.0-or-later
// The one linear program of this field: few rows, variables in [-1,1].
#pragma once

#include <memory>
#include <optional>

#include "cordon/core/answer.hpp"
#include "cordon/core/types.hpp"

namespace cordon {

/// The polytope P = {ξ ∈ Rᵍ : Aξ = b, ‖ξ‖∞ ≤ 1} and certified questions about it.
///
/// A dual simplex method proposes points and multipliers (and GLPK, where that fails); what is
/// answered follows from a check of the proposal with rounding errors bounded, so that a solver's
/// failure can cost tightness (`unknown`, a larger bound) but never soundness. Degenerate cases: no
/// rows: P is the unit box. g = 0: P is {0} if b = 0, else ∅. What the first question needs beside
/// A and b is kept, so that one object serves the 2n directions of an interval hull; an answer does
/// not depend on what was asked before. Not thread-safe: one object per thread.
class BoxedProgram {
 public:
  /// How well the rows are known; empty vectors: exactly.
  struct Accuracy {
    Vector magnitude;  ///< size of the terms that each row was computed from, see `is_empty`
    Vector error;  ///< bound of |b - true right-hand side|: what is proven holds for the true one
  };
  BoxedProgram(Matrix A, Vector b) : BoxedProgram(std::move(A), std::move(b), Accuracy{}) {}
  BoxedProgram(Matrix A, Vector b, Accuracy accuracy);
  ~BoxedProgram();
  BoxedProgram(BoxedProgram&&) noexcept;
  BoxedProgram& operator=(BoxedProgram&&) noexcept;

  /// Result of `maximum`.
  struct Bound {
    double upper = 0;  ///< max gᵀξ ≤ upper, certified by `y`; -inf if P is proven empty (then y is
                       ///< a Farkas vector)
    Vector y;                  ///< multipliers: upper = bᵀy + ‖g - Aᵀy‖₁, rounded up
    std::optional<Vector> xi;  ///< the solver's maximiser, not proven feasible
    bool solved = false;  ///< the solver claims optimality (for information: nothing rests on it)
  };
  /// Certified upper bound of max{gᵀξ : ξ ∈ P}.
  Bound maximum(VectorIn g);
  /// The same without the maximiser, in the memory of an earlier bound.
  void upper_bound(VectorIn g, Bound& bound);

  /// Is P empty? `yes` by a Farkas vector y: bᵀy > ‖Aᵀy‖₁; `no` by a point whose residual is
  /// repaired rigorously. "Empty" is said only if the margin exceeds 1e-10 of the terms it is made
  /// of, |y|ᵀ(|b| + |A|1 + magnitude): a smaller one may stem from rounding in the operations that
  /// made A and b.
  Answer is_empty(Certificate* why = nullptr);

  /// A point well inside P where there is one: ξ with the smallest ‖ξ‖∞ that satisfies the rows (up
  /// to rounding). Nothing when the solver found none with ‖ξ‖∞ ≤ 1 + beyond; nothing is proven by
  /// that.
  std::optional<Vector> central_point(double beyond = 1e-9);

  /// h with gᵀξ ≥ h for some point ξ proven to lie in P near `xi`; -inf when no such proof
  /// succeeds.
  double lower_support(VectorIn g, VectorIn xi);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Checks bᵀy > ‖Aᵀy‖₁ with rounding errors bounded; returns the certified margin (positive: P is
/// empty), for every right-hand side within `error` of b.
double farkas_margin(MatrixIn A, VectorIn b, VectorIn y, VectorIn error = Vector(0));

/// Proves that some ξ' near ξ satisfies Aξ' = b and returns an upper bound of |ξ' - ξ|, entry by
/// entry, or nothing; that ‖ξ'‖∞ ≤ 1 follows where |ξ| plus this is at most 1. The correction is
/// sought in the span of D Aᵀ, D = diag(1 - |ξ|); (A D Aᵀ) is verified to be regular by an
/// approximate inverse R with ‖I - R A D Aᵀ‖∞ < 1. Fails for dependent rows. Holds for every
/// right-hand side within `error` of b. O(m² g + m³).
std::optional<Vector> repair_radius(MatrixIn A, VectorIn b, VectorIn xi,
                                    VectorIn error = Vector(0));

}  // namespace cordon
