// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <string>

#include "cordon/core/answer.hpp"
#include "cordon/core/types.hpp"

namespace cordon::invariant {

/// ρ(A) = max |λ|, the largest modulus of an eigenvalue; 0 for n = 0. Nominal: of a matrix far from
/// normal it may have no right digit. Errors: Errc::dimension for an A that is not square,
/// Errc::not_finite. O(n³).
double spectral_radius(MatrixIn A);

/// lower ≤ ρ ≤ upper, proven
struct RadiusBounds {
  double lower = 0, upper = infinity;
};

/// Bounds of ρ(X) for all X with |X - A| ≤ error, entry by entry (`error` empty: A itself), by
/// Gershgorin's discs in a basis of eigenvectors [Feingold1962], and where there is none by powers,
///   (|tr Xᵐ| / n)^(1/m) ≤ ρ(X) ≤ ‖Xᵐ‖∞^(1/m),   m = 1, 2, 4, …, and 3m for the traces,
/// all rounding errors included. Both agree with ρ to 1e-9 where the eigenvectors are
/// well-conditioned; {0, ∞} where nothing is known. Errors as above. O(n³); powers take some 50
/// products.
RadiusBounds radius_bounds(MatrixIn A, MatrixIn error = Matrix());

/// A closed loop A - L C (C p×n, L n×p) for the numbers that the three hold, no rounding in
/// between.
struct ClosedLoop {
  Answer schur = Answer::unknown;  ///< ρ < 1, proven; `unknown` only beyond 40 states, or at the
                                   ///< limits of doubles
  RadiusBounds radius;  ///< upper ≤ 1 if Schur (1 if no more is known), lower ≥ 1 if not
  /// A - L C ≥ 0 in every entry; `unknown`: not so, but no entry is below zero by more than its own
  /// rounding
  Answer nonnegative = Answer::unknown;
  Matrix value,
      error;  ///< A - L C as computed, and |A - L C - value| ≤ error; not finite where doubles end
};

/// By bounds of the radius where they decide, else in rational arithmetic [Jury1964]: milliseconds
/// for 10 states, seconds for 30. Errors: Errc::dimension, Errc::not_finite.
ClosedLoop closed_loop(MatrixIn A, MatrixIn L, MatrixIn C);

/// ρ(A) < 1, as proven by `closed_loop` without an L.
Answer is_schur(MatrixIn A);

/// Refuses an A that is not Schur, ρ(A) ≥ 1, with Errc::invalid: "`what` is not Schur: it has the
/// eigenvalue 1.08 + 0.2i (modulus 1.1)", or whose radius is not known, with Errc::unsupported. n =
/// 0 is Schur. Other errors as above.
void require_schur(MatrixIn A, const std::string& what);

/// What is wrong with a matrix that is not Schur, or not proven so: "is not Schur: …". `A` gives
/// the numbers to show; an eigenvalue is named as one only where its modulus agrees with bounds
/// that are proven.
std::string not_schur(Answer schur, MatrixIn A);

}  // namespace cordon::invariant
