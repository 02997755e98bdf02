// SPDX-License-Identifier: GPL-3.0-or-later
// Proofs about rows whose lines were eliminated, held against the rows as they were.
#pragma once

#include <vector>

#include "cordon/core/line_elimination.hpp"

namespace cordon {

/// Sizes of S δ in rows S δ + A ξ + U u = b whose lines were eliminated, as far as rows were solved
/// for them: what an elimination rounds in coefficients of lines is multiplied by these. The
/// columns of U were behind those of A.
struct TermsOfLines {
  Vector terms;        ///< for ‖ξ‖∞ ≤ 1 and u = 0
  Matrix input_terms;  ///< per input, a column each

  TermsOfLines(MatrixIn S, const LinesEliminated& rest, Index inputs);
};

/// What an elimination tells of the lines δ that satisfy the rows it used up.
struct LinesReached {
  Vector reach;             ///< |δ| ≤ reach for ‖ξ‖∞ ≤ 1
  std::vector<Index> free;  ///< lines that no row was solved for
};

/// Does Sδ + Aξ = b, the constraints of `rows`, have no solution with ‖ξ‖∞ ≤ 1 for any b within
/// `tube_row_noise` of `terms`, by the multipliers y that were led back over the lines? An
/// elimination in doubles drops entries of lines that cancel up to rounding; what they multiply may
/// be as large as it likes. Tells by rational arithmetic where that is affordable. Else with Sᵀy =
/// r ≠ 0 by rounding, for lines of the length that the solved rows give them:
///   bᵀy - ‖Aᵀy‖₁ > 2 |r|ᵀ reach.
/// False in doubt. O(m (l + g)), and what `is_quickly_proven_empty` allows.
bool proves_empty_through_lines(const LineForm& rows, const Vector& terms, const Vector& y,
                                const LinesReached& lines);

}  // namespace cordon
