// SPDX-License-Identifier: GPL-3.0-or-later
// The convex hull of points that become known one by one, in doubles, for a handful of dimensions.
#pragma once

#include <functional>
#include <vector>

#include "cordon/core/types.hpp"

namespace cordon::designers {

/// conv(points) in Rʳ, r ≥ 1, by its facets h·(x - o) ≤ 1 around the centre o of the first simplex:
/// the vertices of the polar polytope, cut by one half-space per point (double description
/// [Fukuda1996]). New facets are convex combinations of old ones, so that errors do not grow.
/// Points count as lying on a facet up to `tolerance`.
class GrowingHull {
 public:
  struct Facet {
    Vector h;
    std::vector<Index> on = {};  ///< numbers of the points on it, increasing
    bool settled = false;        ///< for the caller, as are the proof and the level that settle it
    Vector proof = {};
    double proven = 0;
  };
  /// r + 1 points (columns) in general position, known up to `accuracy` in each direction;
  /// otherwise there are no facets.
  GrowingHull(const Matrix& simplex, double accuracy);

  /// How far x is beyond a facet (positive), in units of the facet's distance from o.
  double beyond(const Facet& facet, VectorIn x) const { return facet.h.dot(x - centre_) - 1; }
  double tolerance(const Facet& facet) const { return 1e-12 + accuracy_ * facet.h.norm(); }
  /// k in h/|h| · x ≤ k.
  double level(const Facet& facet) const { return (facet.h.dot(centre_) + 1) / facet.h.norm(); }
  /// False if `over` ended it half way: the hull is of no use then.
  bool add(VectorIn x, const std::function<bool()>& over);

  /// Is no facet missing? Rounding can hide one where the set is thin. True: every ridge of every
  /// facet lies on a second one, the ridges being the facets of a closed hull of their own; as
  /// facets are connected by ridges, there are no others.
  bool is_closed() const;

  std::vector<Facet>& facets() { return facets_; }
  const std::vector<Facet>& facets() const { return facets_; }

 private:
  bool has_neighbours(const Facet& facet) const;

  Vector centre_;
  double accuracy_;
  Index points_ = 0;
  std::vector<Vector> offsets_;  ///< of the points, from the centre
  std::vector<Facet> facets_;
};

}  // namespace cordon::designers
