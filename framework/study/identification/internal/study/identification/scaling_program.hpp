// SPDX-License-Identifier: GPL-3.0-or-later
// The linear program of the smallest factors.
#pragma once

#include <vector>

#include "cordon/solvers/sparse_program.hpp"
#include "cordon/study/identify.hpp"

namespace cordon::identification {

/// Which factor scales a generator; the others stay as they are.
struct Factors {
  std::vector<Index> of_disturbances, of_noises;  ///< per generator; -1: none
  Index count = 0;
};
Factors factors_of(const Model& model, Scaled scaled);

/// Columns: the factors, x_k for all k, the factors of the generators of w_k, v_k and x_0, and how
/// far x_0 goes along the lines of X0.
struct ScalingProgram {
  SparseProgram program;
  /// The row of an output in a sample; -1: it is missing.
  std::vector<std::vector<Index>> output_rows;
};
ScalingProgram scaling_program(const Model& model, std::span<const Sample> samples,
                               const Factors& factors);

}  // namespace cordon::identification
