// SPDX-License-Identifier: GPL-3.0-or-later
// Façade of the linear-programming solver. Its answers are proposals: see boxed_program.hpp for
// what is proven.
#pragma once

#include <memory>

#include "cordon/core/types.hpp"

namespace cordon {

/// maximise gᵀx subject to A x = b, lower ≤ x ≤ upper. Bounds may be infinite; A may have no rows.
/// An object belongs to the thread that made it: on another one every solve is `failed`.
/// The constraint matrix is loaded once; objectives change cheaply and the basis is kept from solve
/// to solve.
class LinearProgram {
 public:
  LinearProgram(MatrixIn A, VectorIn b, VectorIn lower, VectorIn upper);
  ~LinearProgram();
  LinearProgram(LinearProgram&&) noexcept;
  LinearProgram& operator=(LinearProgram&&) noexcept;

  enum class Status {
    optimal,     ///< the solver claims optimality of `x` and `y`
    infeasible,  ///< the solver claims that no point satisfies the constraints
    unbounded,   ///< the solver claims that the objective is unbounded
    failed       ///< no claim: iteration limit, numerical trouble, …
  };
  struct Solution {
    Status status = Status::failed;
    Vector x;  ///< primal values (valid for `optimal`)
    Vector y;  ///< row multipliers with g - Aᵀy the reduced costs (valid for `optimal`)
    double objective = 0;
  };
  /// Throws Errc::not_finite for NaN in g. A failure of the solver is a status, never an exception.
  Solution maximize(VectorIn g);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cordon
