// SPDX-License-Identifier: GPL-3.0-or-later
// How multipliers of the outputs determine those of the equations of the state, in rational
// arithmetic.
#pragma once

#include "cordon/interfaces/model.hpp"
#include "solvers/rational.hpp"

namespace cordon::identification {

using rational::Rational;
using rational::RationalMatrix;
using rational::RationalVector;

RationalVector times(const RationalMatrix& A, const RationalVector& x);
RationalMatrix transposed(const RationalMatrix& A);
void add(RationalVector& to, const RationalVector& x);
double largest(const RationalVector& x);  ///< magnitude, rounded; 0 without entries

/// E as it is used (DescriptorMatrix), the numbers themselves: left core⁻¹ right where it is not
/// used as written, and the identity without one.
RationalMatrix exact_descriptor(const LinearModel& model);

/// With μ_k of the outputs and p_k of E x_{k+1} = A x_k + B u_k + Bw w_k,
///   r_k = Cᵀ μ_k + Aᵀ p_k,   Eᵀ p_{k-1} = r_k for k > 0:
/// p_{k-1} = J r_k + N ν, N a basis of the kernel of Eᵀ (s columns, one for each static row), as
/// long as r_k is orthogonal to the kernel of E, R. Where Nᵀ A R is regular (index 1) this
/// determines ν_k = -(Rᵀ Aᵀ N)⁻¹ Rᵀ q of r_k = q + Aᵀ N ν_k, q = Cᵀ μ_k + Aᵀ J r_{k+1}; so that
/// p_k = J r_{k+1} + Z q and r_k = (1 + Aᵀ Z) q.
struct Costates {
  explicit Costates(const LinearModel& model);

  Index static_rows = 0;
  bool is_determined = true;
  RationalMatrix J, N, R, Z;  ///< n×n, n×s, n×s, n×n; Z is of size 0 if there is none
  RationalMatrix At, Ct, from_next, from_static;  ///< Aᵀ, Cᵀ, Aᵀ J, Aᵀ N
  /// (1 + Aᵀ Z) Cᵀ and (1 + Aᵀ Z) Aᵀ J; Cᵀ and Aᵀ J where no Z determines ν_k.
  RationalMatrix of_outputs, of_next;
};

}  // namespace cordon::identification
