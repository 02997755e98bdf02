// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/core/types.hpp"

namespace cordon::estimators {

struct NormBounds {
  double lower = 0, upper = 0;
};

/// Bounds of ‖(zI - A)⁻¹ B‖∞ = max_ω σ₁(H(ω)), H(ω) = (I - e^{-iω} A)⁻¹ B, for every Schur A and
/// every B with ‖A - `A`‖₂ ≤ A_error, ‖B - `B`‖₂ ≤ B_error. {∞, ∞} if `A` is not Schur and A_error
/// = 0, {0, ∞} where no bound is known: neither `A` nor the errors tell it.
///
/// [0, π] is divided until an upper bound that holds between the frequencies meets the largest
/// value at one of them: with T = (I - e^{-iω} A)⁻¹ - I, H'' = -T (I + 2T) H, and over a distance d
/// from a frequency ‖T‖ and ‖H‖ grow by 1 / (1 - d ‖T‖) at most; so σ₁ between two frequencies
/// exceeds the larger of their values by at most ‖T‖ (1 + 2 ‖T‖) ‖H‖ h² / 8. Relative gap 1e-9,
/// more where the limit of 20000 frequencies comes first; rounding errors of the values are allowed
/// for, and those of A and B by ‖H‖ → (‖H‖ + r B_error) / (1 - r A_error), r = ‖(I - e^{-iω} A)⁻¹‖.
/// O(n³) each. Errors: Errc::dimension, Errc::not_finite.
NormBounds h_infinity_norm(MatrixIn A, MatrixIn B, double A_error = 0, double B_error = 0);

}  // namespace cordon::estimators
