// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cordon/core/line_form.hpp"

namespace cordon {

/// X with the lines that its constraints determine turned into factors, without any rounding.
///
/// Lines δ_Λ that are the only ones in rows P with a regular square S_PΛ are bounded on X: with R ≈
/// S_PΛ⁻¹ and E = I - R S_PΛ,
///   |δ| ≤ |R (b - Aξ)| + |E| |δ|,   so that v + |E| d < d, v ≥ |R b| + |R A| 1, proves |δ| ≤ d.
/// With d rounded up to powers of two, δ = diag(d) ζ, ‖ζ‖∞ ≤ 1 describes the same set by numbers
/// that are products with powers of two. The bounds are implied: nothing is lost and nothing is
/// added. Looked at are rows with one line, and then groups of rows and lines that have nothing to
/// do with the others. A group whose rows do not determine its lines, or for which the proof fails
/// (S_PΛ near to singular, overflow), stays as it is.
struct BoundedLines {
  LineForm set;  ///< equal to X; new factors come after those of X
  struct Pivot {
    Index row, factor;
  };
  std::vector<Pivot>
      pivots;  ///< one row per new factor that can be solved for it (all of a group together)
};
/// O(l³ + l² g) for l lines. [Neumaier1990, ch. 4]
BoundedLines bound_lines(const LineForm& X);

}  // namespace cordon
