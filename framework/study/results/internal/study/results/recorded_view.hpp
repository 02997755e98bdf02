// SPDX-License-Identifier: GPL-3.0-or-later
// What sets.jsonl keeps of a set, and in which planes reports draw it.
#pragma once

#include <utility>
#include <vector>

#include "cordon/core/box.hpp"
#include "cordon/interfaces/set.hpp"

namespace cordon::detail {

/// The pairs of coordinates that sets are drawn in: all up to four states, three of more.
std::vector<std::pair<Index, Index>> drawn_planes(Index states);

/// Sixteen directions in each of these planes (one per column), evenly spread where the hull is a
/// square; the axes alone where the hull is unbounded or there is one coordinate.
Matrix directions_in_planes(const Box& hull);

/// The view of the set; where its form is an outer one, with its support values along those of
/// these directions in which they are smaller than the form's, by more than `tolerances::reported`
/// (1e-9) of its width.
View recorded_view(const Set& X, const Box& hull);

}  // namespace cordon::detail
