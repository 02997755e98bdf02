// SPDX-License-Identifier: GPL-3.0-or-later
// Proposals for max{gᵀξ : Aξ = b, ‖ξ‖∞ ≤ 1}, of any units.
#pragma once

#include <optional>
#include <vector>

#include "cordon/core/types.hpp"
#include "solvers/basis_guess.hpp"
#include "solvers/box_simplex.hpp"
#include "solvers/interior_point.hpp"

namespace cordon {

/// Brings rows and objectives to entries near 1 by powers of two, guesses a basis and runs the dual
/// simplex method from there. Programs of a hundred rows, and smaller ones that take the simplex
/// method long, are solved by an interior-point method, whose solution becomes the guess, and the
/// answer where a corner is still far from it. Where all that fails, GLPK may find multipliers.
/// Variables that enter no row are left out and put at their bounds; sets that were reduced have
/// many. A proposal depends on the question alone, not on what was asked before.
class BoxSolver {
 public:
  BoxSolver(const Matrix& A, const Vector& b);

  using Status = BoxSimplex::Status;
  Status maximize(VectorIn g, double enough = BoxSimplex::any);
  /// The same by another solver: optimal or unsolved.
  Status second_opinion(VectorIn g);

  /// Of the last call, unless it was unsolved: for the rows and the objective as given.
  const Vector& multipliers() const { return y_; }
  /// Of the last call with `optimal`: gᵀξ for the solution ξ, and ξ itself.
  double value() const { return value_; }
  void take_point(Vector& xi);

 private:
  /// Rows divided by their scales, without coefficients that are noise.
  struct Scaled {
    Vector scale;
    Matrix A;                   ///< the columns that are not zero
    std::vector<Index> active;  ///< which these are
    explicit Scaled(const Matrix& whole);
  };
  BoxSolver(Scaled rows, const Vector& b, Index cols);
  void take_objective(VectorIn g);
  Status solve(double enough);
  Status solve_from_inside(double enough);

  Scaled rows_;
  Vector b_, objective_, y_;
  BoxSimplex simplex_;
  std::optional<BasisGuess> guess_;
  std::optional<InteriorPoint> interior_;
  std::optional<Vector> point_;  ///< another solver's than the simplex method's
  Vector bounds_;  ///< where the objective is largest over the box alone: ±1 per variable
  double idle_ = 0, value_ = 0;  ///< `idle_`: the part of the value by variables that enter no row
  int power_ = 0;                ///< the objective was divided by 2 to this power
};

}  // namespace cordon
