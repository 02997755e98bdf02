// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes cut by half-spaces, in exchange form: what Polytope::to_line_form writes, read again
// without rounding and without the limits of general forms.
#pragma once

#include <optional>

#include "cordon/core/line_form.hpp"
#include "cordon/solvers/polytope.hpp"

namespace cordon::plugins {

/// {c + Mδ + Gξ : ‖ξ‖∞ ≤ 1, Aξ = b} where each row of G has one entry at most, and each column one,
/// or none and one in A: the slack of its row, of which every row has one at most. Nothing for
/// other forms. The polytope equals the form.
std::optional<Polytope> polytope_of_cut_box(const LineForm& X);

/// Of a cut box with these vertices, the `facets` rows with the largest facets, measured in units
/// of the box (with lines: that cut the box deepest); the others are dropped, and with them their
/// slacks. Encloses it.
LineForm with_largest_facets(const LineForm& X, const Matrix& vertices, Index facets);

}  // namespace cordon::plugins
