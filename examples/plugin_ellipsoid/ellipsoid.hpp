// SPDX-License-Identifier: GPL-3.0-or-later
// Ellipsoids as values: the arithmetic, without any object of the framework.
#pragma once

#include <cordon/core/answer.hpp>
#include <cordon/core/box.hpp>
#include <cordon/core/line_form.hpp>
#include <span>
#include <vector>

namespace ellipsoid {

using cordon::Answer;
using cordon::Box;
using cordon::Index;
using cordon::LineForm;
using cordon::Matrix;
using cordon::MatrixIn;
using cordon::Vector;
using cordon::VectorIn;

/// {c + L u + w : ‖u‖₂ ≤ 1, |w| ≤ r}, or ∅: an ellipsoid of shape matrix P = L Lᵀ, which may be
/// singular, and a box that takes up the rounding errors of everything that was done to it. Shapes:
/// c n, L n×k, r n. The factor L is kept in place of P: squares of small half axes would drown in
/// those of large ones.
struct Ellipsoid {
  Vector c;
  Matrix L;
  Vector r;
  bool empty = false;

  Index dim() const { return c.size(); }
  /// Number of half axes that are not zero, as far as the factor shows it.
  Index axes() const;
};

Ellipsoid make_empty(Index n);

/// An ellipsoid around a set, and whether it is that set (up to rounding errors).
struct Result {
  Ellipsoid set;
  bool exact = false;
};

/// T X + t; exact.
Ellipsoid affine_map(const Ellipsoid& X, MatrixIn T, VectorIn t);

/// X₁ ⊕ X₂ ⊕ …: the ellipsoid of least trace among those of the family P = Σsᵢ · Σ Pᵢ/sᵢ, sᵢ > 0,
/// which is reached at sᵢ = √tr Pᵢ [Kurzhanski1997, section 2.2]. Exact if at most one summand is
/// not a point. At least one summand, equal dimensions.
Result sum(std::span<const Ellipsoid> summands);

/// What a cut makes smallest: the sum of squares of the half axes, or the volume.
enum class Criterion { trace, volume };

/// {x : lower ≤ aᵀx ≤ upper}, one bound may be infinite. `error` bounds what aᵀx itself is
/// uncertain by.
struct Strip {
  Vector a;
  double lower, upper, error = 0;
};

/// Encloses X ∩ strip by the best ellipsoid of the family that shrinks X along one direction
/// [Fogel1982; Maksarov1996]. Empty only if the strip lies beyond X by more than rounding errors; X
/// itself if the strip says nothing about it. O(n k).
Ellipsoid cut(const Ellipsoid& X, const Strip& strip, Criterion criterion);

/// Encloses {x ∈ X : R x ∈ Y}, by cuts along the axes of Y.
Ellipsoid intersection(const Ellipsoid& X, MatrixIn R, const Ellipsoid& Y, Criterion criterion);

/// Encloses conv(X ∪ Y) for non-empty X, Y: P ≽ P_X, P_Y, and the segment between the centres.
Ellipsoid convex_hull(const Ellipsoid& X, const Ellipsoid& Y);

/// Encloses X. Exact for a point, a segment and in one dimension. Throws Errc::unsupported for an
/// unbounded X.
Result enclose(const LineForm& X, Criterion criterion);

/// The box along the principal axes: encloses X.
LineForm principal_box(const Ellipsoid& X);

double support(const Ellipsoid& X, VectorIn d);  ///< upper bound of sup{dᵀx}; -inf for ∅
Box interval_hull(const Ellipsoid& X);
Answer contains(const Ellipsoid& X, VectorIn x);
double volume(const Ellipsoid& X);  ///< of an X ≠ ∅; negative if rounding errors would show in it

}  // namespace ellipsoid
