// SPDX-License-Identifier: GPL-3.0-or-later
// The one decision about the rank of a descriptor matrix E, for whoever asks which equations of E
// x⁺ = A x + B u + Bw w are static.
#pragma once

#include <vector>

#include "cordon/core/types.hpp"

namespace cordon {

/// E (n×n, finite) as it is used. Its rank r is the number of singular values above 1e-10 of the
/// largest one, rows scaled by powers of two to entries of about 1, so that it does not depend on
/// the units of equations. An E that is singular in decimals (0.1, 0.3; 0.3, 0.9) is regular as
/// doubles: taken literally, rows that are static would determine states by dividing by rounding
/// errors.
///
/// Where the doubles have the rank r themselves, E is used as it stands (`as_written`). Otherwise
/// the matrix of rank r
///   Ê = left core⁻¹ right
/// takes its place, where `core` (r×r, regular) are the pivots' rows and columns of E, `left` their
/// columns, `right` their rows: Ê has the entries of E in these rows and columns, and differs
/// elsewhere by what was decided to be rounding. The blocks are doubles of E, so that statements
/// about Ê need no rounding: E x⁺ = f becomes core z = right x⁺, left z = f.
struct DescriptorMatrix {
  Index rank = 0;
  bool as_written = true;
  Matrix left, core, right;  ///< E, identity and identity where E is used as it stands

  /// Errc::dimension if E is not square, Errc::not_finite for NaN and infinity. O(n³). The rank of
  /// the doubles is found modulo a prime: it may, for a matrix made for the purpose, come out too
  /// small, never too large, so that an E of smaller rank is always used as it stands.
  explicit DescriptorMatrix(MatrixIn E);

  /// Rows and columns of the r pivots of Gaussian elimination with complete pivoting, in their
  /// order; rows are scaled by powers of two to entries of about 1, and so are columns where that
  /// leaves the rank at r. Errors as above.
  struct Pivots {
    std::vector<Index> rows, cols;
  };
  static Pivots pivots_of(MatrixIn E);
};

/// r alone.
Index descriptor_rank(MatrixIn E);

/// Rank of the matrix of doubles, and of that of the shortest decimals that read back as these
/// doubles, as files write them.
Index rank_of_doubles(MatrixIn E);
Index rank_of_decimals(MatrixIn E);

}  // namespace cordon
