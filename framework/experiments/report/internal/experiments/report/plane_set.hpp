// SPDX-License-Identifier: GPL-3.0-or-later
// Sets in two coordinates, as they are drawn.
#pragma once

#include <cstddef>
#include <vector>

#include "cordon/core/view.hpp"
#include "experiments/report/figure.hpp"

namespace cordon::report {

struct PlanePoint {
  double x = 0, y = 0;
};

/// The projection of a set to two coordinates. What it stands for lies inside, up to
/// `display_precision` (1e-7) of its size.
struct PlaneSet {
  enum class Kind {
    empty,    ///< proven
    bounded,  ///< the convex hull of `vertices`
    strip,    ///< lower ≤ normalᵀ(x, y) ≤ upper
    plane
  };
  Kind kind = Kind::empty;
  std::vector<PlanePoint> vertices;  ///< counter-clockwise; one: a point, two: a segment
  PlanePoint normal;                 ///< of length 1
  double lower = 0, upper = 0;
};

struct PlaneLimits {
  std::size_t vertices = 1000;    ///< of the polygon, 4 at least
  std::size_t directions = 2000;  ///< that support values are asked in, beside the four of the axes
};

/// Coordinates i and j (i ≠ j) of X. Without constraints and lines from the generators
/// alone; otherwise by support values: of the region between an inner and an outer polygon, the
/// largest corner is asked for first, until every edge of the outer polygon is one of the set. What
/// is left open, and vertices beyond the limit, make the polygon larger, never smaller. Recession
/// cones of exchange forms are subspaces, so that there are no other kinds.
PlaneSet project(const LineForm& X, Index i, Index j, const PlaneLimits& limits = {});
/// The same, cut by those inequalities that are about these two coordinates alone; where the form
/// is unbounded, by all as constraints.
PlaneSet project(const View& X, Index i, Index j, const PlaneLimits& limits = {});

/// Joins edges where that adds least area, until there are `limit` ≥ 4 vertices at most: the result
/// contains the polygon.
std::vector<PlanePoint> with_fewer_vertices(std::vector<PlanePoint> polygon, std::size_t limit);

/// The part of the set inside the window of `frame`, as a polygon whose edges on the window are
/// `open`. False: there is none.
bool cut(const PlaneSet& set, const SetFrame& frame, Polygon& out);

}  // namespace cordon::report
