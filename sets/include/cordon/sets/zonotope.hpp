// SPDX-License-Identifier: GPL-3.0-or-later
// Zonotopes: affine images of the unit box.
//
// Definition: {c + Gξ : ‖ξ‖∞ ≤ 1}, c ∈ Rⁿ, G ∈ R^{n×g}. Bounded and never empty; g = 0 is the point
// c. Rounding: nominal, but for `interval_hull` and `support`, whose bounds hold for the numbers as
// stored. Errors: Errc::dimension for sizes that do not fit, Errc::not_finite for NaN or infinite
// entries. Sources: [Kuhn1998], [Girard2005], [Alamo2005].
#pragma once

#include <optional>
#include <span>

#include "cordon/core/box.hpp"
#include "cordon/core/interval_matrix.hpp"

namespace cordon::sets {

struct Zonotope {
  Vector c;
  Matrix G;

  Index dim() const { return c.size(); }
  Index generators() const { return G.cols(); }
};

/// Throws unless G has as many rows as c and all entries are finite; `what` names the set in the
/// message.
void check(const Zonotope& Z, const char* what);

/// T Z + t; exact. O(m n g).
Zonotope affine_map(const Zonotope& Z, MatrixIn T, VectorIn t);

/// X ⊕ Y = <c_X + c_Y, [G_X G_Y]>; exact. O(n g).
Zonotope minkowski_sum(const Zonotope& X, const Zonotope& Y);

/// The summand T·set of `affine_sum`; a view.
struct MappedZonotope {
  MatrixIn T;
  const Zonotope& set;
};

/// A Z ⊕ {f} ⊕ Σ Tᵢ Zᵢ; exact, assembled without temporaries. A is m×n, Tᵢ is m×dim Zᵢ. With
/// summands, where the sum is so flat that later operations could take rounding errors for the set,
/// one generator per coordinate covers them. O(m Σ nᵢ gᵢ).
Zonotope affine_sum(const Zonotope& Z, MatrixIn A, VectorIn f,
                    std::span<const MappedZonotope> summands);

/// X × Y; exact. O(n g).
Zonotope cartesian_product(const Zonotope& X, const Zonotope& Y);

/// A zonotope around conv(X ∪ Y): generators are paired, and a pair a, b gives (a + b)/2 and (a -
/// b)/2, whose support is max(|dᵀa|, |dᵀb|); one without partner stays; (c_X - c_Y)/2 is added.
/// Pairs are chosen greedily by the mean width they save. Outer; exact if X = Y. O(n p q + p q
/// log(p q)). [Girard2005]
Zonotope convex_hull(const Zonotope& X, const Zonotope& Y);

/// The inclusion ◇: a zonotope around {A x : A ∈ [A], x ∈ Z}, mid(A) Z ⊕ diag(rad(A)(|c| + |G| 1))
/// [-1,1]ᵐ; outer, exact if rad(A) = 0. O(m n g). [Kuhn1998]
Zonotope interval_map(const Zonotope& Z, const IntervalMatrix& A);

/// c ± |G| 1: the smallest box around Z, rounded outward. O(n g).
Box interval_hull(const Zonotope& Z);

/// h_Z(d) = dᵀc + ‖Gᵀd‖₁, rounded up. O(n g).
double support(const Zonotope& Z, VectorIn d);

/// ‖G‖_F, a size that the segment-minimising intersection minimises. O(n g).
double f_radius(const Zonotope& Z);

/// 2ⁿ Σ |det G_J| over all n-subsets J of the columns: exact. Nothing if there are more than
/// `max_subsets`. 0 for g < n, 1 for n = 0. O(n³ C(g, n)). [Gover2010]
std::optional<double> volume(const Zonotope& Z, Index max_subsets = 200000);

/// The same with a bound of its rounding errors: between `lower` and `upper`. Nothing as above.
struct ZonotopeVolume {
  double value = 0, lower = 0, upper = 0;
};
std::optional<ZonotopeVolume> volume_with_error(const Zonotope& Z, Index max_subsets = 200000);

/// An upper bound of the volume: the smaller of those of the interval hull and of enclosing
/// parallelotopes. O(n² g²).
double volume_bound(const Zonotope& Z);

/// Z without its zero generators; exact.
Zonotope drop_zero_generators(const Zonotope& Z);

/// Z with parallel generators added up (to the first of them), zero ones dropped: the same set.
/// Generators count as parallel when each entry deviates by a few units in its last place. O(n g²).
Zonotope merge_parallel_generators(const Zonotope& Z);

}  // namespace cordon::sets
