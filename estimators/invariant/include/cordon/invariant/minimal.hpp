// SPDX-License-Identifier: GPL-3.0-or-later
// Support functions of the minimal invariant set of x⁺ = A x + d, d ∈ D, and of all states that can
// be reached when the set of the disturbance switches at will.
#pragma once

#include <string>
#include <vector>

#include "cordon/core/rounding.hpp"
#include "cordon/sets/zonotope.hpp"

namespace cordon::invariant {

/// Proof that the powers of A decay: σ ≥ Σ_k ‖Aᵏ‖ in the norm ‖r‖ = Σ |r_i| p_i of row vectors, for
/// weights p > 0. It rests on a power with ‖A^m‖ ≤ 1/2, computed with bounded rounding errors; m
/// grows by powers of 16, and with B = A¹⁶
///   Σ_{k<m} ‖Aᵏ‖ ≤ (Σ_{k<16} ‖Aᵏ‖) (Σ_{k<m/16} ‖Bᵏ‖),   Σ_k ‖Aᵏ‖ ≤ Σ_{k<m} ‖Aᵏ‖ / (1 - ‖A^m‖).
/// A may be defective. Immutable.
class Decay {
 public:
  /// `size` ≥ 0 (n) is what disturbances have in each coordinate; it decides about p only. Errors:
  /// Errc::invalid if A is not Schur, with the eigenvalue, named `what`; Errc::unsupported if no
  /// power is found (an eigenvalue so near to the unit circle that rounding hides it);
  /// Errc::dimension, Errc::not_finite. O(n³ log m).
  Decay(MatrixIn A, VectorIn size, const std::string& what = "the matrix");

  const Matrix& matrix() const { return A_; }
  Index dim() const { return A_.rows(); }
  double sum() const { return sum_; }  ///< σ
  double norm(VectorIn r) const;       ///< ‖r‖, rounded up
  double share(const sets::Zonotope& D)
      const;  ///< max_i (|c| + |G| 1)_i / p_i, rounded up: |h_D(r)| ≤ share ‖r‖
  double product_error(VectorIn r) const;  ///< bound of ‖fl(r A) - r A‖

 private:
  Matrix A_, magnitude_;
  Vector weights_;
  double sum_ = 1;
};

/// h(d) and h(-d), each between bounds that hold for the numbers as stored.
struct SupportPair {
  Interval plus, minus;
};

/// The minimal invariant sets Ω_i = Σ_k Aᵏ D_i of several disturbance sets in one direction:
///   h(d) = Σ_k (dᵀ Aᵏ c_i + ‖dᵀ Aᵏ G_i‖₁) = dᵀ (I - A)⁻¹ c_i + Σ_k ‖dᵀ Aᵏ G_i‖₁,
/// summed until what is left, at most σ share(D_i) ‖dᵀAᵏ‖, is below `accuracy` times the sum (or
/// times the share of ‖d‖, if the set is that flat), and then added. Rounding errors are bounded in
/// the same way: h(r) ≤ Σ_{k<T} φ(r̃_k) + Σ_k H(r̃_k A - r̃_{k+1})
/// + H(r̃_T). No decomposition of A. D_i = {c} is allowed, no D_i gives no pair; n = 0 gives 0.
/// Errors: Errc::dimension, Errc::not_finite, Errc::invalid unless 0 < accuracy < 1,
/// Errc::unsupported beyond 10⁶ terms. O(T n Σ g_i). [Rakovic2005]
std::vector<SupportPair> minimal_supports(const Decay& decay, const std::vector<sets::Zonotope>& D,
                                          VectorIn d, double accuracy);
/// The same for one set.
SupportPair minimal_support(MatrixIn A, const sets::Zonotope& D, VectorIn d, double accuracy);

/// Upper bounds in the directions d and -d of all states that are reachable at any time t ≥ 0 from
/// X₀ ∈ one of `starts` (none: {0}), whichever of the D_i holds at each step:
///   h(d) = sup_t [max_l h_{X₀,l}((Aᵗ)ᵀ d) + Σ_{s<t} max_i h_{D_i}((Aˢ)ᵀ d)],
/// and the minimal invariant sets of each D_i alone, from the same powers. Errors and complexity as
/// above.
struct SwitchedSupports {
  std::vector<SupportPair> minimal;
  double plus = 0, minus = 0;
};
SwitchedSupports switched_supports(const Decay& decay, const std::vector<sets::Zonotope>& D,
                                   const std::vector<sets::Zonotope>& starts, VectorIn d,
                                   double accuracy);

/// The finite part Σ_{k<T} Aᵏ D under T_out (q×n), with the bound of the rest: T_out Ω ⊆ part ⊕
/// box(±rest), and part ⊆ T_out Ω up to rest in its centre. T is the first number for which each
/// rest is below `accuracy` of the part's width (or as above). At most `max_columns` generators are
/// kept, the largest; the others go to `rest`.
struct PartialSum {
  sets::Zonotope part;
  Vector rest;
};
PartialSum partial_sum(const Decay& decay, const sets::Zonotope& D, MatrixIn T_out, double accuracy,
                       Index max_columns);

}  // namespace cordon::invariant
