// SPDX-License-Identifier: GPL-3.0-or-later
// How far a point is outside of a zonotope, and by which normal.
#pragma once

#include <optional>

#include "cordon/core/types.hpp"
#include "cordon/solvers/lp.hpp"

namespace cordon::designers {

/// g(z) = min{‖ξ‖∞ : Gξ = z} = max{λᵀz : ‖Gᵀλ‖₁ ≤ 1}, a norm, for generators that span their space:
/// κ(u) = g(N u - c) - 1.
class Gauge {
 public:
  explicit Gauge(const Matrix& G);

  struct Value {
    double value = 0;
    Vector lambda, xi;  ///< of both programs
  };
  /// Nothing where the solver fails.
  std::optional<Value> at(const Vector& z);

 private:
  Index rows_, generators_;
  LinearProgram program_;
};

}  // namespace cordon::designers
