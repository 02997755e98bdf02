// SPDX-License-Identifier: GPL-3.0-or-later
// Ellipsoids that carry their rounding errors.
//
// Definition: {c + L u + w : ‖u‖₂ ≤ 1, |w| ≤ r}, an ellipsoid of shape matrix P = L Lᵀ, which may
// be singular, and a box that takes up the rounding errors of everything that was done to it.
// Shapes: c n, L n×k, r n; k = 0 is the point c. Bounded and never empty. The factor L is kept in
// place of P: squares of small half axes would drown in those of large ones, and P could become
// indefinite.
//
// Rounding: outward throughout. What an operation returns encloses its exact result for the numbers
// as stored; support and hull are upper bounds. Errors: Errc::dimension for shapes that do not fit,
// Errc::not_finite after an overflow. Sources: [Kurzhanski1997], [Fogel1982], [Maksarov1996].
#pragma once

#include <optional>
#include <vector>

#include "cordon/core/answer.hpp"
#include "cordon/core/box.hpp"
#include "cordon/core/line_form.hpp"
#include "cordon/sets/zonotope.hpp"

namespace cordon::sets {

struct Ellipsoid {
  Vector c;
  Matrix L;
  Vector r;

  Index dim() const { return c.size(); }
  /// Number of half axes that are not zero, as far as the factor shows it.
  Index axes() const;
};

/// An ellipsoid around a set, and whether it is that set up to rounding errors.
struct EnclosingEllipsoid {
  Ellipsoid set;
  bool exact = false;
};

/// What an ellipsoid around a set makes smallest: the sum of squares of the half axes, or the
/// volume.
enum class EllipsoidCriterion { trace, volume };

/// {f} ⊕ Σ Tᵢ Sᵢ in the ellipsoid of least trace among those of the family P = Σsᵢ · Σ Pᵢ/sᵢ, sᵢ >
/// 0, which is reached at sᵢ = √tr Pᵢ [Kurzhanski1997, section 2.2]. Every generator of a zonotope
/// is a summand by itself, after the map, so that the trace is least of the image.
class EllipsoidSum {
 public:
  explicit EllipsoidSum(VectorIn f);
  void add(MatrixIn T, const Ellipsoid& X);
  void add(MatrixIn T, const Zonotope& Z);
  /// {|w| ≤ radius}.
  void add_box(VectorIn radius);
  /// Exact if at most one summand is not a point, and in one dimension. At most n columns. O(n² k)
  /// for k columns in all.
  EnclosingEllipsoid enclosed() const;

 private:
  void add_centre(MatrixIn T, VectorIn c);
  void add_block(Matrix block);
  struct Stacked {
    Matrix L;
    Index blocks = 0;  ///< that are not zero
    bool noise = false;
  };
  Stacked stacked(Vector& r) const;
  bool fold(Matrix& L, Vector& r) const;

  Vector c_, magnitude_, r_;
  Index terms_ = 1;
  std::vector<Matrix> blocks_;
};

/// A zonotope's ellipsoid: of least trace as in `EllipsoidSum`, or, for `volume`, P = m G Gᵀ of m
/// generators, the smallest one around a parallelotope. Exact for a point, a segment and in one
/// dimension.
EnclosingEllipsoid enclose(const Zonotope& Z, EllipsoidCriterion criterion);

/// The same of a set without lines, with constraints: the smaller of the ellipsoids around the box
/// and around a zonotope without constraints, cut by the hull. Nothing if X is proven empty.
std::optional<EnclosingEllipsoid> enclose(const LineForm& X, EllipsoidCriterion criterion);

/// {x : lower ≤ aᵀx ≤ upper}, one bound may be infinite. `error` bounds what aᵀx itself is
/// uncertain by.
struct EllipsoidStrip {
  Vector a;
  double lower, upper, error = 0;
};

/// Encloses X ∩ strip by the best ellipsoid of the family that shrinks X along one direction; X
/// itself where the strip says nothing about it. Nothing if the strip is proven to lie beyond X, by
/// more than the share `margin` of the terms. O(n k).
std::optional<Ellipsoid> cut(const Ellipsoid& X, const EllipsoidStrip& strip,
                             EllipsoidCriterion criterion, double margin = 0);

/// A centre m and squared half axes a² = κ b² and b² along and across the direction, for the unit
/// ball in `k` dimensions cut to α ≤ t ≤ β, t the coordinate along it, -1 ≤ α < β ≤ 1, k ≥ 2.
struct SlabEllipsoid {
  double m = 0, a = 1, b = 1;
};
/// μ = (α+β)/2, h = (β-α)/2: m = μ(1-κ), b² = 1 - μ² - h² + h²/κ + μ²κ. 0 < κ ≤ 1 is clamped: above
/// 1 the ellipsoid does not hold the slab; at 1 it is the ball. For `volume` κ makes κ bᵏ smallest,
/// for `trace` along·a² + across·b² with `ratio` = across/along. Both ends are checked, and a and b
/// raised to hold them, rounding included.
SlabEllipsoid slab_ellipsoid(double alpha, double beta, EllipsoidCriterion criterion, double ratio,
                             Index k);

/// Encloses conv(X ∪ Y): P ≽ P_X, P_Y, and the segment between the centres.
Ellipsoid convex_hull(const Ellipsoid& X, const Ellipsoid& Y);

/// The box along the principal axes: encloses X.
Zonotope principal_box(const Ellipsoid& X);

/// Upper bound of sup{dᵀx}: dᵀc + ‖Lᵀd‖₂ + |d|ᵀr. O(n k).
double support(const Ellipsoid& X, VectorIn d);
/// c ± (‖row of L‖₂ + r), rounded outward. O(n k).
Box interval_hull(const Ellipsoid& X);
/// `yes` by factors u, `no` by a direction.
Answer contains(const Ellipsoid& X, VectorIn x);

/// An upper bound of the volume, and whether it is the volume to 1e-8. Nothing if L is flat, or
/// nearly so.
struct EllipsoidVolume {
  double value = 0;
  bool exact = false;
};
std::optional<EllipsoidVolume> volume(const Ellipsoid& X);

}  // namespace cordon::sets
