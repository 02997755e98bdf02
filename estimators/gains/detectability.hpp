// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "cordon/core/types.hpp"

namespace cordon::estimators {

/// A mode of A, an eigenvalue λ with |λ| ≥ 1 as computed, that does not show in C x: rank [λI - A; C] < n, by singular values
/// below 1e-10 of the largest. In words, with the direction: "the mode 1.2 of A, along (0, 1), does not show in the outputs".
/// Nothing if there is none, so that (A, C) is detectable. A and C finite, n×n and p×n.
std::optional<std::string> undetectable_mode(const Matrix& A, const Matrix& C);

/// The same among all eigenvalues: nothing if (A, C) is observable.
std::optional<std::string> unobservable_mode(const Matrix& A, const Matrix& C);

}  // namespace cordon::estimators
