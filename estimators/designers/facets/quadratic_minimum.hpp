// SPDX-License-Identifier: GPL-3.0-or-later
// A small strictly separable quadratic program, proposed by linear systems for guesses of what is
// active.
#pragma once

#include <optional>

#include "cordon/core/types.hpp"

namespace cordon::designers {

/// min Σ p_i (D z + o)_i²  subject to  A z = b,  F z ≥ e,  |z_j| ≤ 1.
struct QuadraticProgram {
  Matrix D;
  Vector o, price;
  Matrix A;
  Vector b;
  Matrix F;
  Vector e;
};

/// A point and multipliers of A and F that satisfy the conditions of optimality up to rounding.
struct QuadraticMinimum {
  Vector z, of_A, of_F;
};

/// From a point near the minimum; nothing if a few changes of the active bounds and rows do not
/// lead to it. Nothing is proven.
std::optional<QuadraticMinimum> quadratic_minimum(const QuadraticProgram& program, Vector z);

}  // namespace cordon::designers
