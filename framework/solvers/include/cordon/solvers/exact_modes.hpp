// SPDX-License-Identifier: GPL-3.0-or-later
// Rank, observability and detectability in rational arithmetic: the doubles are taken as the
// numbers they are.
#pragma once

#include "cordon/core/types.hpp"

namespace cordon::exact {

/// rank M, by elimination. Errc::not_finite.
Index rank(MatrixIn M);

/// The part of x⁺ = A x that y = C x never shows: N = {x : C Aʲ x = 0 for all j ≥ 0}, which A maps
/// into itself.
struct HiddenModes {
  Index count = 0;  ///< d = dim N; 0: (A, C) is observable
  bool decay =
      true;  ///< |λ|² < rate for each eigenvalue λ of A on N. With rate 1: (A, C) is detectable
  Matrix basis, map;  ///< N in columns (n×d) and A on N (d×d), A basis = basis map; their entries
                      ///< rounded to doubles
};

/// A n×n, C p×n, rate > 0. No eigenvalue is computed: the characteristic polynomial of A on N (of
/// A² / rate, where rate is not 1) is tested after Schur and Cohn [Jury1964]. Errors:
/// Errc::dimension, Errc::not_finite, Errc::invalid for another rate, Errc::unsupported for n > 40.
/// O(n⁴) products of long numbers: milliseconds for 10 states, seconds for 30.
HiddenModes hidden_modes(MatrixIn A, MatrixIn C, double rate = 1);

/// |λ| < 1 for each eigenvalue λ of A - L C (A n×n, L n×p, C p×n), the product and the difference
/// taken without rounding. Tested as above; same errors and costs.
bool is_schur(MatrixIn A, MatrixIn L, MatrixIn C);

/// A - L C ≥ 0 in every entry, without rounding. Errc::dimension, Errc::not_finite. O(n² p).
bool is_nonnegative(MatrixIn A, MatrixIn L, MatrixIn C);

}  // namespace cordon::exact
