// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cordon/core/types.hpp"

namespace cordon::invariant {

/// ρ(A) = max |λ|, the largest modulus of an eigenvalue; 0 for n = 0. Nominal. Errors: Errc::dimension for an A that is not
/// square, Errc::not_finite. O(n³).
double spectral_radius(MatrixIn A);

/// Refuses an A that is not Schur, ρ(A) ≥ 1, with Errc::invalid: "`what` is not Schur: it has the eigenvalue 1.08 + 0.2i (modulus
/// 1.1)". n = 0 is Schur. Nominal: what rests on the decay of Aᵏ proves it (cordon/invariant/minimal.hpp). Other errors as above.
void require_schur(MatrixIn A, const std::string& what);

}  // namespace cordon::invariant
