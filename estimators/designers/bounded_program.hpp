// SPDX-License-Identifier: GPL-3.0-or-later
// Linear programs of the searches, whose minima are proven from below by multipliers.
#pragma once

#include "cordon/core/types.hpp"

namespace cordon::designers {

/// A bound of one of the variables or slacks, with room for rounding: a larger one is a bound as
/// well.
double roomy(double bound);

/// Variables with bounds on both sides, min costᵀx subject to A x = b.
struct BoundedProgram {
  Matrix A;
  Vector b, error;  ///< |the row as meant - the row as stored| within the bounds, per row
  Vector lower, upper, cost;

  Index add_column(double from, double to, double price);
  /// rowᵀx = right; columns that are added later do not enter.
  Index add_row(const Vector& row, double right, double error);
  /// rowᵀx - s = right, 0 ≤ s ≤ most.
  void add_row_above(Vector row, double right, double error, double most);
};

/// Whatever y is: min costᵀx ≥ bᵀy + Σ_j min{(cost - Aᵀy)_j x_j : lower_j ≤ x_j ≤ upper_j} -
/// |y|ᵀerror, rounded down [Neumaier2004].
double proven_minimum(const BoundedProgram& program, VectorIn y);

}  // namespace cordon::designers
