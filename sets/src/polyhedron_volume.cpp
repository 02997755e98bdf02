// SPDX-License-Identifier: GPL-3.0-or-later
// Volume between an inscribed and a circumscribed polytope. Both come from the hull of points of
// the set that are moved to a grid: computed in integers, it is exact however near the points are
// to each other.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "cordon/sets/vertices.hpp"
#include "support_query.hpp"

namespace cordon::sets {

namespace {

using Point = Eigen::Vector3d;
using Node =
    Eigen::Matrix<std::int64_t, 3, 1>;  ///< point of the grid, counted in steps from the origin
__extension__ typedef __int128 Wide;

constexpr double flat_tolerance =
    1e-8;  ///< thickness, relative to the interval hull, of which rounding leaves too few digits
constexpr double grid_step = 0x1p-36;  ///< of the grid
constexpr double moved =
    0.8661 * grid_step;  ///< how far a point is moved to the grid at most: √3/2 steps
/// Differences of such nodes are at most 2⁴¹ steps, so that their determinants stay below 2¹²⁶.
constexpr double largest_coordinate = 16;

Node nearest_node(const Point& x) { return (x / grid_step).array().round().cast<std::int64_t>(); }
Point position(const Node& a) { return a.cast<double>() * grid_step; }

Point cross(const Point& a, const Point& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(),
          a.x() * b.y() - a.y() * b.x()};
}

/// The same without rounding errors.
std::array<Wide, 3> exact_cross(const Node& a, const Node& b) {
  const auto minor = [&](Index i, Index j) {
    return static_cast<Wide>(a[i]) * b[j] - static_cast<Wide>(a[j]) * b[i];
  };
  return {minor(1, 2), minor(2, 0), minor(0, 1)};
}

/// Triangle with its corners counter-clockwise from outside; neighbour i lies across the edge from
/// corner i to corner i + 1.
struct Facet {
  std::array<std::size_t, 3> corner;
  std::array<std::size_t, 3> neighbour{};
  std::array<Wide, 3> exact{};   ///< normal of any length
  Point normal = Point::Zero();  ///< the same of length 1
  double offset = 0;             ///< normalᵀx on the facet
  double support = 0;            ///< of the set along the normal, once asked
  Point farthest = Point::Zero();
  std::size_t seen_by = 0;  ///< the last point that saw this facet
  bool alive = true, asked = false;
};

/// Convex hull of nodes that grows node by node, without rounding errors.
class Hull {
 public:
  /// The hull of the origin and the three unit points.
  Hull() {
    const Node origin = Node::Zero();
    nodes_ = {origin, nearest_node(Point::Unit(0)), nearest_node(Point::Unit(1)),
              nearest_node(Point::Unit(2))};
    const std::array<std::array<std::size_t, 3>, 4> corners{
        {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
    for (const auto& corner : corners) add_facet(corner);
    // across 0-2, 2-1, 1-0; 0-1, 1-3, 3-0; 1-2, 2-3, 3-1; 0-3, 3-2, 2-0
    facets_[0].neighbour = {3, 2, 1};
    facets_[1].neighbour = {0, 2, 3};
    facets_[2].neighbour = {0, 3, 1};
    facets_[3].neighbour = {1, 2, 0};
  }

  std::vector<Facet>& facets() { return facets_; }

  double volume() const {
    double six = 0;
    for (const Facet& f : facets_) {
      if (!f.alive) continue;
      const Point a = position(nodes_[f.corner[0]]), b = position(nodes_[f.corner[1]]),
                  c = position(nodes_[f.corner[2]]);
      six += a.dot(cross(b, c));
    }
    return six / 6;
  }

  bool sees(const Node& x, const Facet& f) const {
    const Node d = x - nodes_[f.corner[0]];
    return f.exact[0] * d[0] + f.exact[1] * d[1] + f.exact[2] * d[2] > 0;
  }

  /// Replaces the facets that x sees, found from `start` (which it sees), by a cone with apex x.
  /// The edges around them form one cycle, and no edge is in line with x.
  void insert(std::size_t start, const Node& x) {
    nodes_.push_back(x);
    const std::vector<Edge> horizon = remove_seen(start, x);
    std::unordered_map<std::size_t, std::size_t> by_start,
        by_end;  // first and second corner of a horizon edge → its new facet
    for (std::size_t k = 0; k < horizon.size(); ++k) {
      by_start[horizon[k].from] = facets_.size() + k;
      by_end[horizon[k].to] = facets_.size() + k;
    }
    for (const Edge& edge : horizon) {
      facets_[edge.outside].neighbour[edge.side] = facets_.size();
      add_facet({edge.from, edge.to, nodes_.size() - 1});
      facets_.back().neighbour = {edge.outside, by_start.at(edge.to), by_end.at(edge.from)};
    }
  }

 private:
  /// Edge of a removed facet whose other facet, `outside`, stays; it is that one's edge number
  /// `side`.
  struct Edge {
    std::size_t from, to, outside, side;
  };

  void add_facet(const std::array<std::size_t, 3>& corner) {
    Facet f{corner};
    const Node& p = nodes_[corner[0]];
    f.exact = exact_cross(nodes_[corner[1]] - p, nodes_[corner[2]] - p);
    f.normal = Point(static_cast<double>(f.exact[0]), static_cast<double>(f.exact[1]),
                     static_cast<double>(f.exact[2]));
    f.normal.stableNormalize();
    f.offset = f.normal.dot(position(p));
    facets_.push_back(f);
  }

  std::vector<Edge> remove_seen(std::size_t start, const Node& x) {
    const std::size_t mark = nodes_.size();
    std::vector<std::size_t> seen{start};
    facets_[start].seen_by = mark;
    for (std::size_t k = 0; k < seen.size(); ++k) {
      for (const std::size_t next : facets_[seen[k]].neighbour) {
        if (facets_[next].seen_by == mark || !sees(x, facets_[next])) continue;
        facets_[next].seen_by = mark;
        seen.push_back(next);
      }
    }
    std::vector<Edge> horizon;
    for (const std::size_t k : seen) {
      Facet& f = facets_[k];
      f.alive = false;
      for (std::size_t i = 0; i < 3; ++i) {
        const Facet& outside = facets_[f.neighbour[i]];
        if (outside.seen_by == mark) continue;
        const std::size_t to = f.corner[(i + 1) % 3];
        const auto side =
            std::find(outside.corner.begin(), outside.corner.end(), to) - outside.corner.begin();
        horizon.push_back({f.corner[i], to, f.neighbour[i], static_cast<std::size_t>(side)});
      }
    }
    return horizon;
  }

  std::vector<Node> nodes_;
  std::vector<Facet> facets_;
};

/// Of the support points along ±d, the one farther from the line or plane through `origin`,
/// measured along d.
Point farther(const ScaledSet& set, const Point& d, const Point& origin) {
  const Point a = set.query(d).x, b = set.query(-d).x;
  return d.dot(a - origin) >= d.dot(origin - b) ? a : b;
}

/// Four points of X that span as much as a few queries show; false if X is flat.
bool spanning_simplex(const ScaledSet& set, std::array<Point, 4>& p) {
  double longest = 0;
  for (Index i = 0; i < 3; ++i) {
    const Vector axis = Vector::Unit(3, i);
    const Point a = set.query(axis).x, b = set.query(-axis).x;
    if ((a - b).norm() <= longest) continue;
    longest = (a - b).norm();
    p[0] = a;
    p[1] = b;
  }
  if (!(longest > flat_tolerance)) return false;
  const Point along = (p[1] - p[0]) / longest;
  Index smallest = 0;
  along.cwiseAbs().minCoeff(&smallest);
  Point u = cross(along, Point::Unit(smallest));
  u /= u.norm();
  const Point v = cross(along, u);
  double widest = 0;
  for (const Point& d : {u, v}) {
    const Point candidate = farther(set, d, p[0]);
    const double width = std::abs(d.dot(candidate - p[0]));
    if (width <= widest) continue;
    widest = width;
    p[2] = candidate;
  }
  if (!(widest > flat_tolerance)) return false;
  Point normal = cross(p[1] - p[0], p[2] - p[0]);
  normal /= normal.norm();
  p[3] = farther(set, normal, p[0]);
  return std::abs(normal.dot(p[3] - p[0])) > flat_tolerance;
}

/// A point inside of the first simplex, farther than 0.14 from its facets, and thus from those of
/// every hull.
Point inner_point() { return Point::Constant(0.25); }

double distance(const Facet& f) { return f.offset - f.normal.dot(inner_point()); }

/// Asks for the support of every new facet; false at the limit.
bool ask_facets(Hull& hull, const ScaledSet& set, Index& queries, Index max_queries) {
  for (Facet& f : hull.facets()) {
    if (!f.alive || f.asked) continue;
    if (++queries > max_queries) return false;
    const SupportPoint answer = set.query(f.normal);
    f.support = answer.h;
    f.farthest = answer.x;
    f.asked = true;
  }
  return true;
}

/// With o the inner point, o + λ (hull - o) ⊆ X ⊆ o + μ (hull - o). The outer one holds as every
/// facet's half-space, moved away from o by its part of μ, holds X. The inner one: the support
/// functions differ by `moved` at most, which is a share of moved / distance of the hull's. A
/// support below a facet contradicts the points of X and lowers λ in the same way.
VolumeBounds bounds_of(Hull& hull) {
  double inner = 1, outer = 1;
  for (const Facet& f : hull.facets()) {
    if (!f.alive) continue;
    const double gap = f.support - f.offset;
    inner = std::min(inner, 1 + (std::min(gap, 0.0) - moved) / distance(f));
    outer = std::max(outer, 1 + gap / distance(f));
  }
  inner = std::max(inner, 0.0);
  const double volume = hull.volume();
  return {volume * inner * inner * inner, volume * outer * outer * outer, false};
}

/// Adds the farthest point beyond each facet where the gap is more than its share of `aim`. False
/// if there is none.
bool grow(Hull& hull, double aim) {
  bool grown = false;
  const std::size_t count = hull.facets().size();
  for (std::size_t i = 0; i < count; ++i) {
    const Facet& f = hull.facets()[i];
    if (!f.alive || f.support - f.offset <= aim / 8 * distance(f)) continue;
    if (!(f.farthest.cwiseAbs().maxCoeff() <= largest_coordinate))
      continue;  // nothing but noise lies there
    const Node x = nearest_node(f.farthest);
    if (!hull.sees(x, f)) continue;
    hull.insert(i, x);
    grown = true;
  }
  return grown;
}

bool agree(const VolumeBounds& bounds, double tolerance) {
  return bounds.upper <= bounds.lower * (1 + tolerance);
}

}  // namespace

VolumeBounds volume(const SupportOracle& X, double relative_tolerance, Index max_queries) {
  ScaledSet set(X, 3, "volume");
  std::array<Point, 4> simplex;
  if (set.is_empty()) return {0, 0, true};
  const auto thin = [&X] {
    const double upper = turned_box(X, 3).volume;
    return VolumeBounds{0, upper, upper == 0};
  };
  if (set.is_flat() || !spanning_simplex(set, simplex)) return thin();
  Matrix B(3, 3);
  B << simplex[1] - simplex[0], simplex[2] - simplex[0], simplex[3] - simplex[0];
  if (!set.transform(simplex[0], B)) return thin();
  const double factor = set.volume_factor(), aim = relative_tolerance / 100;
  Hull hull;
  Index queries = 0;
  VolumeBounds bounds{0, infinity, false};
  while (ask_facets(hull, set, queries, max_queries)) {
    const VolumeBounds found = bounds_of(hull);
    bounds = {factor * found.lower, factor * found.upper, false};
    if (agree(bounds, aim) || !grow(hull, aim)) break;
  }
  bounds.converged = agree(bounds, relative_tolerance);
  return bounds;
}

}  // namespace cordon::sets
