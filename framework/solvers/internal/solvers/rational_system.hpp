// SPDX-License-Identifier: GPL-3.0-or-later
// Rows with free and boxed variables over the rationals: proofs about them, restored and found.
#pragma once

#include <optional>

#include "cordon/core/types.hpp"
#include "solvers/rational.hpp"

namespace cordon::rational {

/// Sδ + Aξ = plus - minus with δ free and ‖ξ‖∞ ≤ 1, in doubles; the difference is taken exactly.
struct Rows {
  Matrix S, A;
  Vector plus, minus;
};

/// {(δ, ξ) : K (δ, ξ) = r, ‖ξ‖∞ ≤ 1}; the first `lines` variables are free.
struct System {
  explicit System(const Rows& rows);

  RationalMatrix K;
  RationalVector r;
  Index lines;

  Index factors() const { return K.cols() - lines; }
};

/// bᵀy and ‖Aᵀy‖₁ for the y nearby that solves Lᵀy = 0 exactly, L the lines' columns: the system
/// has no solution with ‖ξ‖∞ < bᵀy / ‖Aᵀy‖₁. Nothing if there is no such y.
struct FarkasTerms {
  Rational gain, cost;
};
std::optional<FarkasTerms> farkas_terms(const System& s, VectorIn y);
/// Their difference: positive, and the system has no solution.
std::optional<Rational> farkas_margin(const System& s, VectorIn y);

/// gᵀξ + tᵀδ ≤ bᵀy + ‖g - Aᵀy‖₁ for the y nearby with Lᵀy = t: that bound. The last `inequalities`
/// rows say K (δ, ξ) ≤ r in place of an equation: nothing if y is negative there.
std::optional<Rational> dual_bound(const System& s, const RationalVector& t,
                                   const RationalVector& g, VectorIn y, Index inequalities = 0);

/// The point (δ, ξ), moved onto the rows; nothing if it leaves the bounds then.
std::optional<RationalVector> solution_near(const System& s, VectorIn point);
inline bool has_solution_near(const System& s, VectorIn point) {
  return solution_near(s, point).has_value();
}

/// What the exact simplex method finds: a solution (δ, ξ), or multipliers of the largest gap to a
/// solution, each rounded to doubles. A proof only after one of the checks above.
struct Finding {
  bool feasible;
  Vector data;
};
Finding settle(const Rows& rows);

/// K x = r by elimination in integers [Bareiss1968]; x is 0 outside the pivot columns, which are
/// chosen by |entry| · preference (a column of preference 0 is never one). Nothing if the system is
/// inconsistent on those columns. `rank` (may be null) receives the number of pivots.
std::optional<RationalVector> solve(const RationalMatrix& K, const RationalVector& r,
                                    const Vector& preference, Index* rank = nullptr);

}  // namespace cordon::rational
