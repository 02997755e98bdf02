// SPDX-License-Identifier: GPL-3.0-or-later
// That no smaller factors explain the samples, in rational arithmetic.
#pragma once

#include <optional>

#include "study/identification/scaling_program.hpp"

namespace cordon::identification {

/// For any μ_k with p_k = Cᵀ μ_k + Aᵀ p_{k+1}, and L = {} or p_0 orthogonal to the lines of X0,
///   Σ μ_kᵀ (y_k - D u_k - Dv c_v) - Σ p_kᵀ (B u_{k-1} + Bw c_w) - p_0ᵀ c_0 - ‖G_0ᵀ p_0‖₁
///     = Σ μ_kᵀ Dv G_v ξ_k + Σ p_kᵀ Bw G_w ζ_k - …  ≤ Σ_j s_j D_j + fixed,
/// D_j the magnitudes of the coefficients of the generators that s_j scales, added up over k. So
/// Σ_j s_j ≥ (left - fixed) / max_j D_j.
struct ScalingProof {
  double least;                ///< of the cost, rounded down; 0 at least
  std::vector<Index> samples;  ///< whose μ_k is not 0: their places, in ascending order
};

/// `multipliers`: μ, a column per sample, 0 where outputs are missing. Small ones are left out; the
/// others are moved as little as it takes that p_k is 0 before the first of them, and orthogonal
/// to the lines at k = 0. A bound of `wanted` ends the search for a better one. Nothing if that
/// fails.
std::optional<ScalingProof> scaling_proof(const Model& model, std::span<const Sample> samples,
                                          const Factors& factors, const Matrix& multipliers,
                                          double wanted = infinity);

}  // namespace cordon::identification
