// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "cordon/core/types.hpp"
#include "gains/obstacle.hpp"

namespace cordon::estimators {

/// A mode of A that does not show in C x and does not decay: (A, C) is not detectable. Sought among
/// the eigenvalues as computed, |λ| ≥ 1, by singular values of [λI - A; C] below 1e-10 of the
/// largest; decided in rational arithmetic (exact_modes.hpp):
///   `no`       proven: "the mode 1.2 of A, along (0, 1), does not show in the outputs", the
///   largest of what is hidden; `unknown`  it shows by rounding errors or little more: "… hardly
///   shows in the outputs". So is what is too large to decide.
/// Nothing if there is none, or if all that is hidden decays. With a `rate` below 1: modes with
/// |λ|² > rate in place of |λ| ≥ 1. A and C finite, n×n and p×n.
std::optional<Obstacle> undetectable_mode(const Matrix& A, const Matrix& C, double rate = 1);

/// "no gain exists, the pair (A, C) is not detectable: the mode …", or, where that is not proven,
/// "no gain was sought, …".
std::string not_detectable(const Obstacle& hidden);

/// The same among all eigenvalues: nothing if (A, C) is observable.
std::optional<Obstacle> unobservable_mode(const Matrix& A, const Matrix& C);

}  // namespace cordon::estimators
