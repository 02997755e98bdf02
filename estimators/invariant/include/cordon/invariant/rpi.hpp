// SPDX-License-Identifier: GPL-3.0-or-later
// Invariant zonotopes of x⁺ = A x + d, d ∈ D, and the iteration that makes them smaller.
#pragma once

#include "cordon/sets/zonotope.hpp"

namespace cordon::invariant {

/// A robust positively invariant set Φ: A Φ ⊕ D ⊆ Φ for D = <c, G>, in closed form from A = V Λ
/// V⁻¹:
///   Φ = (I - A)⁻¹ c ⊕ {x : |V⁻¹ x| ≤ r},   r = (I - |Λ|)⁻¹ |V⁻¹ G| 1,
/// for real eigenvalues the zonotope with shape V diag(r). A pair of complex eigenvalues has a disc
/// in the plane of Re v and Im v; a regular polygon takes its place, with inradius ρ ≥ r such that
/// |λ| times its circumradius and the disturbance fit into it again: at most a quarter wider, with
/// more edges the nearer |λ| is to 1. Deviations of V⁻¹ A V from Λ are bounded and enter r.
/// Contains the minimal set and attracts all trajectories. D = {c} gives the point; n = 0 the point
/// of R⁰. Outer; invariant up to rounding (nominal). Errors: Errc::invalid if A is not Schur, with
/// the eigenvalue, or defective, with the condition of its eigenvectors (above 1e7 after scaling);
/// Errc::dimension, Errc::not_finite. O(n³ + n² g). [Kofman2007; Xu2014, Thm A.1]
sets::Zonotope rpi_set(MatrixIn A, const sets::Zonotope& D);

/// X_steps of X ← A X ⊕ D from X₀ = `start`: c ← A c + c_D, G ← [A G, G_D], without zero columns,
/// and reduced to `max_columns` columns by Combastel's method at every step (0: never). From an
/// invariant start every X_k is invariant (exact without reduction, nominal) and contains the
/// minimal set, and widths never grow unless reduction makes them. Any square A. Errors:
/// Errc::dimension, Errc::not_finite, Errc::invalid for `steps` < 0 and 0 < max_columns < n.
/// O(steps n² g). [Xu2014, Prop. A.1]
sets::Zonotope iterate(MatrixIn A, const sets::Zonotope& D, const sets::Zonotope& start,
                       Index steps, Index max_columns = 0);

}  // namespace cordon::invariant
