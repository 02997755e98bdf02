// SPDX-License-Identifier: GPL-3.0-or-later
// What representations and observers say, checked by the host itself from the set as it is written
// down. "Proven" is said of nothing else.
#pragma once

#include "cordon/interfaces/observer.hpp"

namespace cordon::detail {

/// The estimate is called empty: is the reported set, by the certificate or by a proof of its own?
bool is_proven_empty(const Estimate& estimate);

/// X is said not to hold x: does its view, or a support value that it gives, exclude x?
bool is_proven_outside(const Set& X, const Vector& x);

}  // namespace cordon::detail
