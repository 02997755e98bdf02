// SPDX-License-Identifier: GPL-3.0-or-later
// Zonotopes around the intersection of a zonotope with strips: the measurement update of zonotopic
// observers.
//
// Definition: Z ∩ S with Z = <c, G> and the strip S = {x : |ρᵀx - d| ≤ σ}, σ ≥ 0. For every λ ∈ Rⁿ
// the zonotope
//     Z(λ) = <c + λ (d - ρᵀc), [(I - λρᵀ) G, σλ]>
// encloses it [Alamo2005]; the methods differ in λ.
// Degenerate cases: Z inside S: Z itself. ρ = 0: Z if |d| ≤ σ, else ∅. σ = 0: a hyperplane. g = 0:
// the point c or ∅. An intersection that is proven empty is no zonotope: nothing is returned. The
// gap must exceed the rounding errors of the test and `tolerances::proof_margin` (1e-10) of the
// sizes involved, for a zonotope carries the rounding errors of the operations that made it. A flat
// Z stays flat: λ is chosen in the range of G, where the volume of its own dimension counts. A
// strip that cuts Z on one side only is first narrowed to what Z meets of it. Directions of which ρ
// sees less than `smallest_part` (1e-6), in the coordinates of Z, are not used for λ: what is left
// of them may be rounding.
// Units: λ follows a change of the coordinates' units in all methods, up to ties.
// Rounding: nominal. The rounding errors of ρᵀx are multiplied by λ, whatever its size; they widen
// the strip. Errors: Errc::invalid for σ < 0, Errc::dimension, Errc::not_finite.
#pragma once

#include <optional>

#include "cordon/sets/zonotope.hpp"

namespace cordon::sets {

/// Choice of λ.
enum class StripMethod {
  box,  ///< as `segment`, but of the smallest box around Z along its principal axes in place of Z:
        ///< unlike the squares of many short generators, those of n long ones say how wide the set
        ///< is
  segment,  ///< smallest F-radius: λ = GGᵀρ / (ρᵀGGᵀρ + σ²) [Alamo2005]
  hull,  ///< smallest interval hull: each edge is the shortest that any λ gives it; hyperplanes (σ
         ///< = 0) as `segment`
  bravo,  ///< smallest volume among Z and the g zonotopes with λ = g_j / ρᵀg_j [Bravo2006]
  volume  ///< smallest volume of all λ: a convex piecewise linear problem, solved as a linear
          ///< program [Alamo2005]
};

/// Outer; exact if Z lies in the strip. The volume methods need the (n-1)-subsets of the
/// generators. Beyond 20,000 of them both take, among Z and the λ of `bravo`, the smallest sum of
/// squared instead of absolute determinants (over all λ, `segment` would minimise that). O(n g) for
/// segment, O(n² g + n³) for box, O(n g log g) for hull, O(n³ C(g, n-1)) for the others, O(n² g)
/// beyond the limit.
std::optional<Zonotope> intersect_strip(const Zonotope& Z, VectorIn rho, double d, double sigma,
                                        StripMethod method = StripMethod::box);

/// A zonotope around {x ∈ Z : z - C x ∈ T V}, row by row with the strips |C_i x - (z_i - T_i c_V)|
/// ≤ ‖(T G_V)_i‖₁. T with no columns: C x = z. Rows may be dependent, and repeat what earlier ones
/// said. At most one generator more per row, and, where the result is so flat that later operations
/// could take rounding errors for the set, one more per coordinate. Outer.
std::optional<Zonotope> correct(const Zonotope& Z, MatrixIn C, VectorIn z, MatrixIn T,
                                const Zonotope& V, StripMethod method = StripMethod::box);

}  // namespace cordon::sets
