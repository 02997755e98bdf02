// SPDX-License-Identifier: GPL-3.0-or-later
// The part of the fault estimation filter that does not depend on the noise. [Wang2017]
#pragma once

#include <optional>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/model.hpp"

namespace cordon::estimators {

/// For E x⁺ = A x + … + F n, y = C x + … with n states, m outputs and q faults, and Θ = [E; C]:
///   [T N] = Θ⁺ + S (I - Θ Θ⁺),  so that  T E + N C = I  and  x⁺ = T (A x + … + F n) + N (y⁺ - …)
///   ρ_i = min {σ : C (TA)^(σ-1) T f_i ≠ 0},  Ψ = [(TA)^(ρ_i - 1) T f_i]_i,  Υ = C Ψ,  M = Υ⁺,  Φ =
///   TA Ψ rows of Ω: an orthonormal basis of the y with yᵀΥ = 0.
/// Any gain G = Φ M + Ḡ Ω makes (TA - G C) Ψ = 0: the output error y - C x̂ then holds n_i as Υ
/// n_i(k - ρ_i), and no other time of it.
struct FilterDesign {
  Matrix T, N;                ///< n×n, n×m
  std::vector<Index> delays;  ///< ρ_i
  Matrix Psi, Upsilon;        ///< n×q, m×q
  Matrix left_out;  ///< m×q: sum of the responses before ρ_i, in magnitude, that were taken for 0
  Matrix M, Phi, Omega;  ///< q×m, n×q, (m-q)×m
};

/// S is n×(n+m). Or nothing, and every condition that fails in words, with pointers relative to the
/// diagnoser's object.
std::optional<FilterDesign> design_filter(const LinearModel& model, const Matrix& S,
                                          std::vector<Diagnostic>& problems);

}  // namespace cordon::estimators
