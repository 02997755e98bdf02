// SPDX-License-Identifier: GPL-3.0-or-later
// Proposals for max{gᵀξ : Aξ = b, ‖ξ‖∞ ≤ 1}, of any units.
#pragma once

#include <optional>

#include "cordon/core/types.hpp"
#include "solvers/basis_guess.hpp"
#include "solvers/box_simplex.hpp"

namespace cordon {

/// Brings rows and objectives to entries near 1 by powers of two, guesses a basis and runs the dual simplex method from there;
/// where that fails, GLPK may still find multipliers. A proposal depends on the question alone, not on what was asked before.
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
  BoxSolver(Matrix A, const Vector& b, Vector scale);

  Vector scale_;
  Matrix A_;
  Vector b_, objective_, y_;
  BoxSimplex simplex_;
  std::optional<BasisGuess> guess_;
  std::optional<Vector> point_;  ///< the other solver's
  double value_ = 0;
};

}  // namespace cordon
