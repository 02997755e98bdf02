// SPDX-License-Identifier: GPL-3.0-or-later
// Are the output tubes of two modes disjoint under an input sequence, and how far are they apart?
#pragma once

#include <memory>
#include <vector>

#include "cordon/interfaces/input_designer.hpp"
#include "cordon/tubes/output_tube.hpp"

namespace cordon {

/// The rows of a pair before its lines were eliminated, and what leads back to them.
struct PairRows;

/// Y_i(u) and Y_j(u) meet if and only if G ξ + c = N u for some ‖ξ‖∞ ≤ 1: the rows of both tubes
/// and of y_i = y_j with all lines eliminated [Rego2025, Thm 1, Lemma 3]. Exact up to rounding. No
/// rows: they meet for every u, and no input separates them.
struct PairProgram {
  Index i = 0, j = 0;
  Matrix G;          ///< m×g
  Vector c;          ///< m
  Matrix N;          ///< m×n_u(N+1)
  Vector magnitude;  ///< m, size of the terms that G ξ + c was computed from, ‖ξ‖∞ ≤ 1
  Matrix N_magnitude = {};  ///< m×n_u(N+1), likewise of N; 0×0: nothing cancelled
  Index vanished = 0;  ///< rows that became 0 = 0 up to rounding, and are left out: that tubes meet
                       ///< is not proven then
  std::shared_ptr<const PairRows> whole =
      {};  ///< that tubes are disjoint is held against them; none: nothing was eliminated

  Index rows() const { return c.size(); }
  /// Size of the terms of G ξ + c - N u for ‖ξ‖∞ ≤ 1, |u| ≤ `reach`. The rows are known up to a
  /// small share of it.
  Vector terms(VectorIn reach) const;
};
PairProgram pair_program(Index i, const OutputTube& Yi, Index j, const OutputTube& Yj);
/// All pairs i < j, by i, then by j.
std::vector<PairProgram> pair_programs(const std::vector<OutputTube>& tubes);

/// κ(u) = 1/τ* - 1, τ* = max{τ : Gξ = τ (N u - c), ‖ξ‖∞ ≤ 1, 0 ≤ τ ≤ 10⁹}: a program that always
/// has a solution. κ is convex in u. `kappa_lower` and `disjoint` follow from its multipliers y by
/// a check with rounding errors bounded: κ ≥ yᵀ(N u - c) / ‖Gᵀy‖₁
/// - 1; multipliers that do not stand on the rows as they were, lines among them, prove nothing;
/// `disjoint` is `no` on a repaired point. κ is infinite where no τ > 0 is possible, -1
/// without rows, NaN if the solver gave nothing.
PairSeparation separation(const PairProgram& pair, VectorIn u);

}  // namespace cordon
