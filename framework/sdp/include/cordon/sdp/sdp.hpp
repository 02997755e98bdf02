// SPDX-License-Identifier: GPL-3.0-or-later
// Semidefinite programs: a façade over SDPA's callable library. Nothing else sees it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cordon/core/types.hpp"

namespace cordon {

/// F(x) = constant + Σ x_i F_i ⪰ 0. All matrices are symmetric and of the same size; terms that are
/// absent are 0.
struct MatrixInequality {
  Matrix constant;
  std::vector<std::pair<Index, Matrix>> terms;  ///< (i, F_i), each i at most once
};

/// minimise costᵀ x subject to all inequalities.
struct SemidefiniteProgram {
  Vector cost;
  std::vector<MatrixInequality> inequalities;
};

enum class SdpStatus {
  solved,  ///< x meets the inequalities up to `least_eigenvalue`, and its value is within the gap
           ///< of `bound`
  infeasible,  ///< `proof` was checked: no x meets the inequalities
  unknown      ///< the solver stopped without either, or its answer did not stand the check
};

/// All numbers but `solver_status` are recomputed from the program, x and the dual matrices.
struct SdpSolution {
  SdpStatus status = SdpStatus::unknown;
  Vector x;          ///< solved
  double value = 0;  ///< costᵀ x
  double bound = 0;  ///< value of the dual matrices, less the dual residual times |x|: no x whose
                     ///< entries are no larger than those of the solution does better
  std::vector<double> least_eigenvalue;  ///< of each F(x)
  double dual_residual = 0;              ///< largest |Σ ⟨F_i, Y⟩ - cost_i|
  std::vector<Matrix>
      proof;  ///< infeasible: Y ⪰ 0 with Σ ⟨F_i, Y⟩ = 0 for all i and Σ ⟨constant, Y⟩ < 0
  std::string solver_status;  ///< what SDPA said: "pdOPT", "pdINF", …
  std::string why;            ///< unknown: the reason
};

struct SdpOptions {
  double accuracy = 1e-9;  ///< relative gap, and infeasibility of both sides
  double largest_x = 1e8;  ///< bound of |x| within which a solution is looked for; beyond it the
                           ///< answer is `unknown`
  int iterations = 200;
};

/// Throws Errc::dimension, Errc::not_finite and Errc::invalid (a matrix that is not symmetric) for
/// broken programs. What the solver makes of a good one is a status. One solve at a time in the
/// whole process: SDPA is not thread-safe. O(iterations · (m² s² + m s³
/// + m³)) for m variables and inequalities of size s.
SdpSolution solve(const SemidefiniteProgram& program, const SdpOptions& options = {});

}  // namespace cordon
