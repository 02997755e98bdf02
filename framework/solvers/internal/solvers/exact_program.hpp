// SPDX-License-Identifier: GPL-3.0-or-later
// The linear program of this field in exact arithmetic.
#pragma once

#include <optional>

#include "solvers/rational.hpp"

namespace cordon {

/// max{fᵀδ + gᵀξ : Sδ + Aξ = b, ‖ξ‖∞ ≤ 1} over free δ and boxed ξ. Coefficients are doubles; the
/// right-hand side and the objective may be any rationals.
///
/// Bounded dual simplex method on one fraction-free tableau (entries are minors, all divisions are
/// exact), so that no answer rests on a tolerance. Lines are pivoted first; every basis of what
/// remains is then dual feasible by the choice of bounds. The floating- point solver proposes the
/// first basis; that saves pivots and decides nothing.
struct ExactProgram {
  Matrix S, A;
  rational::RationalVector b;
  rational::RationalVector f, g;  ///< zero (of full size) for a mere question of feasibility

  enum class Status { optimal, infeasible, unbounded };
  struct Result {
    Status status;
    rational::Rational value;                 ///< for `optimal`, like the rest
    std::vector<rational::Rational> xi = {};  ///< a maximiser's boxed part
    std::vector<Index> basis =
        {};  ///< boxed variables whose columns, with those of the lines, solve for the multipliers
    int pivots = 0;  ///< after those that filled the first basis
  };
  /// Errc::solver after an absurd number of pivots.
  Result maximum() const;
};

}  // namespace cordon
