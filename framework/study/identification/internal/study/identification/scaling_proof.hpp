// SPDX-License-Identifier: GPL-3.0-or-later
// That no smaller factors explain the samples, in rational arithmetic.
#pragma once

#include <optional>

#include "study/identification/costates.hpp"
#include "study/identification/scaling_program.hpp"

namespace cordon::identification {

/// For any μ_k of the outputs and p_k of the equations E x_{k+1} = A x_k + B u_k + Bw w_k, k < N,
/// and r_k = Cᵀ μ_k + Aᵀ p_k, with
///   Eᵀ p_{k-1} = r_k for k > 0,   Eᵀ p_{N-1} = 0,   r_0 orthogonal to the lines of X0:
///   Σ μ_kᵀ (y_k - D u_k - Dv c_v) - Σ p_kᵀ (B u_k + Bw c_w) - r_0ᵀ c_0 - ‖G_0ᵀ r_0‖₁
///     ≤ Σ μ_kᵀ Dv G_v ξ_k + Σ p_kᵀ Bw G_w ζ_k  ≤ Σ_j s_j D_j + fixed,
/// D_j the magnitudes of the coefficients of the generators that s_j scales, added up over k. So
/// Σ_j s_j ≥ (left - fixed) / max_j D_j.
struct Certificate {
  std::vector<RationalVector> outputs, steps;  ///< μ_k and p_k, k < N; without entries: 0
};

struct ScalingProof {
  double least;                ///< of the cost, rounded down; 0 at least
  std::vector<Index> samples;  ///< whose μ_k is not 0: their places, in ascending order
  Certificate certificate;
};

/// The bound that these multipliers prove; nothing if they do not meet the conditions above, to the
/// last digit, or outputs that are missing have one. X0 = c_0 + M_0 R^m + G_0 [-1,1]^g.
std::optional<ScalingProof> bound_of(const Model& model, std::span<const Sample> samples,
                                     const Factors& factors, Certificate certificate);

/// What a solver proposes: μ and p, a column per sample, 0 where there is none. Of p only what μ
/// does not determine is used; 0 columns where there are no static rows.
struct Multipliers {
  Matrix outputs, steps;
};

/// Small ones of them are left out; the others are moved as little as it takes that p_k is 0 before
/// the first of them, and r_0 orthogonal to the lines at k = 0. A bound of `wanted` ends the search
/// for a better one. Nothing if that fails; with static rows that do not determine the states that
/// E leaves open (index above 1), it does where too many samples hang together.
std::optional<ScalingProof> scaling_proof(const Model& model, std::span<const Sample> samples,
                                          const Factors& factors, const Multipliers& multipliers,
                                          double wanted = infinity);

}  // namespace cordon::identification
