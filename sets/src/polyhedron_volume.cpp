// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <vector>

#include "cordon/sets/vertices.hpp"
#include "support_query.hpp"

namespace cordon::sets {

namespace {

using Point = Eigen::Vector3d;

constexpr double flat_tolerance = 1e-12;    ///< thickness, relative to the interval hull, that counts as none
constexpr double beyond_tolerance = 1e-11;  ///< how far outside a facet a point must lie to be added
constexpr double coplanar_tolerance =
    1e-12;  ///< facets whose plane is this near to a new point are replaced with the visible ones

Point cross(const Point& a, const Point& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

/// Triangle with its corners counter-clockwise from outside; neighbour i lies across the edge from corner i to corner i + 1.
struct Facet {
  std::array<std::size_t, 3> corner;
  std::array<std::size_t, 3> neighbour{};
  Point normal = Point::Zero();  ///< of length 1; 0 for a degenerate triangle
  double offset = 0;             ///< normalᵀx on the facet
  double support = 0;            ///< of the set along the normal, once asked
  Point farthest = Point::Zero();
  bool alive = true, asked = false;
};

/// Convex hull of points in R³ that grows point by point.
class Hull {
 public:
  explicit Hull(const std::array<Point, 4>& simplex) {
    points_.assign(simplex.begin(), simplex.end());
    const Point& p = points_[0];
    const bool positive = cross(points_[1] - p, points_[2] - p).dot(points_[3] - p) > 0;
    if (!positive) std::swap(points_[1], points_[2]);
    const std::array<std::array<std::size_t, 3>, 4> corners{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
    for (const auto& corner : corners) add_facet(corner);
    // across 0-2, 2-1, 1-0; 0-1, 1-3, 3-0; 1-2, 2-3, 3-1; 0-3, 3-2, 2-0
    facets_[0].neighbour = {3, 2, 1};
    facets_[1].neighbour = {0, 2, 3};
    facets_[2].neighbour = {0, 3, 1};
    facets_[3].neighbour = {1, 2, 0};
  }

  std::vector<Facet>& facets() { return facets_; }

  Point center() const {
    Point sum = Point::Zero();
    for (const Point& p : points_) sum += p;
    return sum / static_cast<double>(points_.size());
  }

  double volume(const Point& apex) const {
    double six = 0;
    for (const Facet& f : facets_) {
      if (!f.alive) continue;
      const Point a = points_[f.corner[0]] - apex, b = points_[f.corner[1]] - apex, c = points_[f.corner[2]] - apex;
      six += a.dot(cross(b, c));
    }
    return six / 6;
  }

  /// Replaces the facets that x sees, found from `start` (which sees it), by a cone with apex x. False, and no change, if
  /// rounding errors leave no simple horizon.
  bool insert(std::size_t start, const Point& x) {
    std::vector<std::size_t> visible;
    std::vector<Edge> horizon;
    explore(start, x, visible, horizon);
    std::unordered_map<std::size_t, std::size_t> by_start, by_end;  // first and second corner of a horizon edge → its new facet
    const std::size_t first = facets_.size();
    for (std::size_t k = 0; k < horizon.size(); ++k) {
      if (!by_start.emplace(horizon[k].from, first + k).second || !by_end.emplace(horizon[k].to, first + k).second) return false;
    }
    for (const Edge& edge : horizon) {
      if (!by_start.contains(edge.to)) return false;
    }
    if (horizon.size() < 3) return false;
    points_.push_back(x);
    for (const std::size_t f : visible) facets_[f].alive = false;
    for (const Edge& edge : horizon) {
      add_facet({edge.from, edge.to, points_.size() - 1});
      facets_.back().neighbour = {edge.outside, by_start[edge.to], by_end[edge.from]};
      std::array<std::size_t, 3>& back = facets_[edge.outside].neighbour;
      back[edge.side] = facets_.size() - 1;
    }
    return true;
  }

 private:
  /// Edge of a visible facet whose other facet, `outside`, is not visible; it is that one's edge number `side`.
  struct Edge {
    std::size_t from, to, outside, side;
  };

  void add_facet(const std::array<std::size_t, 3>& corner) {
    Facet f{corner};
    const Point& p = points_[corner[0]];
    const Point normal = cross(points_[corner[1]] - p, points_[corner[2]] - p);
    const double length = normal.norm();
    if (length > 1e-14) {
      f.normal = normal / length;
      f.offset = f.normal.dot(p);
    }
    facets_.push_back(f);
  }

  void explore(std::size_t start, const Point& x, std::vector<std::size_t>& visible, std::vector<Edge>& horizon) const {
    std::vector<char> state(facets_.size(), 0);  // 1: visible
    const auto sees = [&](const Facet& f) { return f.normal.dot(x) - f.offset > -coplanar_tolerance; };
    visible.push_back(start);
    state[start] = 1;
    for (std::size_t k = 0; k < visible.size(); ++k) {
      for (const std::size_t next : facets_[visible[k]].neighbour) {
        if (state[next] != 0 || !sees(facets_[next])) continue;
        state[next] = 1;
        visible.push_back(next);
      }
    }
    for (const std::size_t f : visible) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t outside = facets_[f].neighbour[i], from = facets_[f].corner[i], to = facets_[f].corner[(i + 1) % 3];
        if (state[outside] != 0) continue;
        std::size_t side = 0;
        while (side < 2 && facets_[outside].corner[side] != to) ++side;
        horizon.push_back({from, to, outside, side});
      }
    }
  }

  std::vector<Point> points_;
  std::vector<Facet> facets_;
};

/// Of the support points along ±d, the one farther from the line or plane through `origin`, measured along d.
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

/// Asks for the support of every new facet. Returns the scale μ ≥ 1 with X ⊆ o + μ (hull - o), or +inf beyond the limit.
double ask_facets(Hull& hull, const ScaledSet& set, const Point& o, Index& queries, Index max_queries) {
  double scale = 1;
  for (Facet& f : hull.facets()) {
    if (!f.alive || f.normal.isZero(0)) continue;
    if (!f.asked) {
      if (++queries > max_queries) return std::numeric_limits<double>::infinity();
      const SupportPoint answer = set.query(f.normal);
      f.support = answer.h;
      f.farthest = answer.x;
      f.asked = true;
    }
    scale = std::max(scale, (f.support - f.normal.dot(o)) / (f.offset - f.normal.dot(o)));
  }
  return scale;
}

bool grow(Hull& hull) {
  bool grown = false;
  const std::size_t count = hull.facets().size();
  for (std::size_t i = 0; i < count; ++i) {
    const Facet& f = hull.facets()[i];
    if (!f.alive || !f.asked || f.normal.dot(f.farthest) - f.offset <= beyond_tolerance) continue;
    const Point x = f.farthest;
    grown |= hull.insert(i, x);
  }
  return grown;
}

}  // namespace

VolumeBounds volume(const SupportOracle& X, double relative_tolerance, Index max_queries) {
  ScaledSet set(X, 3, "volume");
  std::array<Point, 4> simplex;
  if (set.is_empty() || set.is_flat() || !spanning_simplex(set, simplex)) return {0, 0, true};
  Matrix B(3, 3);
  B << simplex[1] - simplex[0], simplex[2] - simplex[0], simplex[3] - simplex[0];
  if (!set.transform(simplex[0], B)) return {0, 0, true};
  const double factor = set.volume_factor();
  Hull hull({Point::Zero(), Point::Unit(0), Point::Unit(1), Point::Unit(2)});
  Index queries = 0;
  VolumeBounds bounds{0, std::numeric_limits<double>::infinity(), false};
  while (!bounds.converged) {
    const Point o = hull.center();
    const double scale = ask_facets(hull, set, o, queries, max_queries), inner = factor * hull.volume(o);
    bounds.lower = std::max(bounds.lower, inner);
    bounds.upper = std::min(bounds.upper, inner * scale * scale * scale);
    bounds.converged = bounds.upper <= bounds.lower * (1 + relative_tolerance);
    if (!std::isfinite(scale) || bounds.converged || !grow(hull)) break;
  }
  return bounds;
}

}  // namespace cordon::sets
