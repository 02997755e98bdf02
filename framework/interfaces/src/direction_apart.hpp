// SPDX-License-Identifier: GPL-3.0-or-later
// A direction in which two convex sets exclude each other, by their support functions alone.
#pragma once

#include <optional>

#include "cordon/core/types.hpp"
#include "cordon/interfaces/set.hpp"

namespace cordon {

/// d with h_X(d) + h_Y(-d) < 0, by more than rounding may amount to: X and Y have no point in
/// common. First the coordinate axes, then the directions of the search for the nearest points
/// [Gilbert1966], as far as both sets tell in which points they reach their support values. Nothing
/// where none was found; that proves nothing. At most 40 + 2n support values of each set.
std::optional<Certificate> direction_apart(const Set& X, const Set& Y);
/// The same for the point y: y ∉ X.
std::optional<Certificate> direction_apart(const Set& X, VectorIn y);

}  // namespace cordon
