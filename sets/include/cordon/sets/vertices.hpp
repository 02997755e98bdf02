// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices, area and volume of bounded sets of two and three dimensions, found through their
// support functions.
#pragma once

#include <functional>

#include "cordon/sets/zonotope.hpp"

namespace cordon::sets {

/// h = sup{dᵀx : x ∈ X} and a point x ∈ X that attains it (both up to rounding).
struct SupportPoint {
  double h = 0;
  Vector x;
};
/// Answers for any direction d ≠ 0. An empty set answers h = -∞, an unbounded direction h = +∞ (x
/// is not read then).
using SupportOracle = std::function<SupportPoint(const Vector& d)>;

/// The oracle of a zonotope: c + G sgn(Gᵀd).
SupportOracle support_oracle(const Zonotope& Z);

/// Vertices of a bounded set X ⊂ R² as the columns of a matrix, counter-clockwise; one column for a
/// point, two for a segment, none for ∅. Each edge between known points is confirmed by its normal
/// or split by a new point. Exact for a polygon up to `tolerance` relative to each coordinate's
/// width; a curved set is cut off after 10,000 queries by an inscribed polygon. Two queries per
/// vertex and edge. Errors: Errc::unsupported for an unbounded set.
Matrix polygon(const SupportOracle& X, double tolerance = 1e-10);

/// Vertices of a zonotope in R² from its generators in the order of their angles: exact; at most
/// 2g. O(g log g).
Matrix polygon(const Zonotope& Z);

/// Area of the polygon with the given vertices (2×k, counter-clockwise); 0 for k < 3. O(k).
double area(const Matrix& vertices);

/// Bounds of a volume: those of an inscribed and of a circumscribed polytope.
struct VolumeBounds {
  double lower = 0, upper = 0;
  bool converged = false;  ///< lower and upper agree to the tolerance
};

/// Volume of a bounded set X ⊂ R³. Known points of X, moved to a fine grid of coordinates in which
/// X is about as thick as it is long, have a hull that is exact in integers; it grows until the
/// support function confirms each of its facets. Bounds follow from what the points are moved,
/// √3/2 steps of a grid of 2⁻³⁶ of the set's size, and from the largest gap between a facet and its
/// support; they hold up to rounding errors of the support function. Asking goes on until they
/// agree to a hundredth of the tolerance; the rest leaves room for an inexact support function. For
/// curved sets, and where rounding hides the thickness of a set, the bounds at the limit of queries
/// or of resolution are returned; those of a set thinner than 1e-8 of its interval hull are 0 and
/// the volume of its `turned_box`. ∅ has the volume 0. Errors: Errc::unsupported for an unbounded
/// set. O(V²) for V vertices, one query per facet tried.
VolumeBounds volume(const SupportOracle& X, double relative_tolerance = 1e-7,
                    Index max_queries = 20000);

/// A box around a set along directions of the set's own.
struct TurnedBox {
  Matrix directions;  ///< columns; orthogonal where each coordinate is scaled by its width
  Vector widths;      ///< along the directions, with room for rounding
  double volume = 0;
};

/// Of a bounded set X ⊂ Rⁿ, n ≤ 3: the longest difference of two known points, the longest one
/// beside it, and so on. Its volume is near that of the interval hull at worst, and small for a
/// thin set however it lies. Room is left for support values that are off by some units in the last
/// place of their terms, so that no set but ∅ has the volume 0. Errors: Errc::unsupported for an
/// unbounded set. At most 8 n queries.
TurnedBox turned_box(const SupportOracle& X, Index n);

}  // namespace cordon::sets
