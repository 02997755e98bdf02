// SPDX-License-Identifier: GPL-3.0-or-later
// The rows that a question about sets asks to satisfy; their variables are the sets' lines and
// factors, in this order.
#pragma once

#include "cordon/core/line_form.hpp"
#include "solvers/rational_system.hpp"

namespace cordon {

rational::Rows rows_of(const LineForm& X);                    ///< X ≠ ∅: Sδ + Aξ = b
rational::Rows rows_of_point(const LineForm& X, VectorIn x);  ///< x ∈ X: Mδ + Gξ = x - c besides
rational::Rows rows_of_intersection(
    const LineForm& X, const LineForm& Y);  ///< X ∩ Y ≠ ∅: Mδ_X + Gξ_X - Mδ_Y - Gξ_Y = c_Y - c_X

}  // namespace cordon
