// SPDX-License-Identifier: GPL-3.0-or-later
// The same semidefinite program in other units: powers of two, so that nothing is rounded on the
// way there and back.
#pragma once

#include <vector>

#include "cordon/sdp/sdp.hpp"

namespace cordon {

/// The same program in other units: row and column r of inequality j times row_scale[j][r], x_i =
/// variable_scale[i] x̃_i, cost times cost_scale; all powers of two, so that nothing is rounded.
/// Variables that appear nowhere are left out. The largest cost is made about 1000, since SDPA
/// stops when its two objective values have come within its own accuracy.
struct ScaledProgram {
  SemidefiniteProgram program;
  std::vector<Vector> row_scale;
  Vector variable_scale;
  double cost_scale = 1;
  std::vector<Index> variables;  ///< that are there
  bool without_bound = false;    ///< one that is not has a cost
  bool exact = true;  ///< no coefficient has left the range of numbers: a proof of one program is
                      ///< one of the other
};

ScaledProgram scale(const SemidefiniteProgram& program);

/// Dual matrices of the given program from those of the scaled one.
std::vector<Matrix> unscaled(const ScaledProgram& scaled, std::vector<Matrix> Y, double factor);

}  // namespace cordon
