// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "cordon/core/types.hpp"

namespace cordon::estimators {

struct PlacedPoles {
  Matrix L;
  double error = 0;  ///< largest distance of an eigenvalue of A - L C from its pole, as computed
};

/// L (n×p) such that A - L C has the `poles`: n numbers, those off the real axis in conjugate
/// pairs, none more often than the rank of C. The left eigenvectors x of A - L C are those of its
/// pole λ with U₁ᵀ (Aᵀ - λ I) x = 0, U₁ a basis of ker C; for several outputs each is chosen in
/// turn as near to the complement of the others as this allows, so that the poles move least when A
/// changes [Kautsky1985]. For one output L is unique. Nothing if the eigenvectors come out
/// dependent. (A, C) should be observable.
std::optional<PlacedPoles> placed_poles(const Matrix& A, const Matrix& C,
                                        const std::vector<std::complex<double>>& poles);

}  // namespace cordon::estimators
