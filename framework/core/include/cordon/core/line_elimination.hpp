// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cordon/core/line_form.hpp"

namespace cordon {

/// X with as many lines eliminated as its constraints allow: {c + Mδ + Gξ : ‖ξ‖∞ ≤ 1, Aξ = b} with
/// independent columns of M, which span the lineality space, and no S. The same set: a line is
/// unbounded, so that solving a row for it loses nothing. Pivots are chosen over the whole of S,
/// largest in its equilibrated row first. A coefficient that cancelled to less than 1e-13 of its
/// terms counts as zero, those of lines also of terms that cancelled before; one that is small but
/// was not cancelled is used, and so is whatever is left of b and c. Where S has more independent
/// rows than pivots were found, in exact arithmetic, rows in which lines were taken for zero are
/// dropped. Rows that become 0 = 0, up to as much, are dropped, a row 0 =
/// b ≠ 0 stays (X is ∅). An entry that cancelled to less than a millionth of its terms is known
/// with few digits and is no pivot; rows in which no other is left are dropped, and so are rows
/// whose coefficients of factors have all cancelled so far (not in `eliminate_lines_traced`): the
/// set becomes larger. O((n + m)(l + g) min(l, m)). [Rego2025, Alg. 1]
LineForm eliminate_lines(const LineForm& X);

/// The same, with the sizes of the terms that were added up: what is left of them after
/// cancellation is known up to a share only. Lines of which that leaves no digits, `vague_column`
/// (1e-4), while exact arithmetic tells that they are there are held by lines along every
/// coordinate that they may reach: the set is larger then.
struct LinesSolved {
  LineForm set;
  Vector row_magnitude;    ///< of every row of `set`, the largest over its entries
  Vector state_magnitude;  ///< of every coordinate, summed over its entries
  bool is_whole = true;    ///< no row with lines was dropped or left without them by rounding only,
                           ///< none that does not follow from the others, and no line added
};
LinesSolved solve_for_lines(const LineForm& X);

/// The same, with what leads back to X. `set` has m' rows, X has m rows and l lines; every row is
/// the combination of X's rows that made it, so that a proof about `set` becomes one about X.
struct LinesEliminated {
  LineForm set;
  Vector row_magnitude;  ///< m', size of the terms that each row was computed from: a violation is
                         ///< known up to a share of it only
  Matrix rows;  ///< m'×m: row k of `set` is rows.row(k) [S A b] (up to rounding, as all of these)
  Matrix outputs;  ///< n×m: [0 G' -c'] = [M G -c] + outputs [S A b] in the eliminated lines
  Matrix lines_by_factors;  ///< l×g and
  Vector lines_offset;  ///< l: δ = lines_offset + lines_by_factors ξ is a choice of lines that
                        ///< satisfies the rows used up
  std::vector<Index> free_lines;  ///< no row was solved for them
  Index vanished = 0;  ///< rows that are left out, as they became 0 = 0 up to rounding, or hold
                       ///< lines that rounding hides: what they said beyond that is lost
  bool follow = true;  ///< all of them follow from the rows used up, in exact arithmetic
};
/// `b_magnitude` (empty: none) is the size of what cancelled in b before.
LinesEliminated eliminate_lines_traced(const LineForm& X, VectorIn b_magnitude);

}  // namespace cordon
