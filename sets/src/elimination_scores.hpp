// SPDX-License-Identifier: GPL-3.0-or-later
// What forgetting |ξ_j| ≤ 1 costs, for every factor at once.
#pragma once

#include <vector>

#include "rows.hpp"

namespace cordon::sets {

/// P = H - (AH)ᵀ(AHAᵀ)⁻¹(AH) with H = (I + GᵀG)⁻¹, kept as I - FᵀF + QᵀQ: F from one factorisation,
/// a row of Q for every factor that was eliminated since. O(g (n + m)²), then O(g (n + m)) per
/// elimination. An object may be used again: its memory stays.
class EliminationScores {
 public:
  /// Of the rows of A named `live`. Rows that depend on others up to rounding are left out: scores
  /// only order candidates.
  void take(const Rows& G, const Rows& A, const std::vector<Index>& live);

  /// r² (‖D G P e_j‖² / P_jj + w) / P_jj for r = `reach`.
  double score(Index j, double reach) const;
  /// ξ_col is no longer bounded.
  void forget(Index col);

  void exchange(WorkspaceExchange& memory) {
    memory.swap(F_, Q_, moved_, diagonal_, moved_squares_, K_, independent_);
  }

 private:
  void sum_squares_of_moves();

  Rows F_;  ///< in its first `rows_` rows
  Index rows_ = 0;
  Rows Q_;  ///< in its first `forgotten_` rows
  Index forgotten_ = 0;
  Rows moved_;  ///< D G P: column j over P_jj is the change of the state when ξ_j moves by one
  Vector diagonal_, moved_squares_;
  Matrix K_;
  std::vector<Index> independent_;
};

}  // namespace cordon::sets
