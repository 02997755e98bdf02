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
/// far x_0 goes along the lines of X0. With static rows the equation of the last sample is there as
/// well, whose x_{k+1} is free. Where E is not used as it is written (DescriptorMatrix), left z =
/// A x_k + B u_k + Bw w_k and core z = right x_{k+1} take its place, z being further columns.
struct ScalingProgram {
  SparseProgram program;
  /// The row of an output in a sample; -1: it is missing.
  std::vector<std::vector<Index>> output_rows;
  /// The first of the n rows of 0 = E x_{k+1} - A x_k - … of a sample; -1: there are none.
  std::vector<Index> step_rows;
};
ScalingProgram scaling_program(const Model& model, std::span<const Sample> samples,
                               const Factors& factors);

}  // namespace cordon::identification
