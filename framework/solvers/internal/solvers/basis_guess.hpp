// SPDX-License-Identifier: GPL-3.0-or-later
// Which variables of max{gᵀξ : Aξ = b, ‖ξ‖∞ ≤ 1} stay off their bounds?
#pragma once

#include <vector>

#include "cordon/core/types.hpp"
#include "solvers/panels.hpp"

namespace cordon {

/// A guess by a few rounds of the alternating direction method of multipliers on the dual, min bᵀy
/// + ‖g - Aᵀy‖₁ [Boyd2011], over orthonormal rows and in single precision: it only orders the
/// columns, and costs a fraction of the simplex iterations that a good first basis saves. The same
/// guess for the same objective, whatever was asked before.
class BasisGuess {
 public:
  /// Dependent rows are no obstacle.
  BasisGuess(const Matrix& A, VectorIn b);

  /// A score per column, the smaller the more likely basic. O(m g) per round.
  const Vector& scores(VectorIn g);

 private:
  void orthonormalise();
  void least_squares();
  void round(float relaxation);
  void total(float threshold);

  Index rounds_;
  Panels<float> rows_;                   ///< Q: orthonormal combinations of the rows of A
  std::vector<float> right_;             ///< the same combinations of b
  std::vector<float> w_;                 ///< multipliers of Q, Qᵀw = Aᵀy
  std::vector<float> sums_;              ///< of the next w, one per row and place in a panel
  std::vector<float> g_, split_, dual_;  ///< per column, with padding: objective, copy of g - Aᵀy,
                                         ///< scaled multiplier of the copy
  float threshold_ = 0;
  Vector scores_;
};

}  // namespace cordon
