// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/vertices.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "require.hpp"
#include "support_query.hpp"

namespace cordon::sets {

namespace {

using Point = Eigen::Vector2d;

double cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Removes points that coincide with their predecessor or lie on the line of their neighbours; the
/// rest is convex.
std::vector<Point> strictly_convex(std::vector<Point> points, double tolerance) {
  bool changed = true;
  while (changed && points.size() > 1) {
    changed = false;
    for (std::size_t i = 0; i < points.size() && points.size() > 1; ++i) {
      const Point& before = points[(i + points.size() - 1) % points.size()];
      const Point& after = points[(i + 1) % points.size()];
      const Point chord = after - before, step = points[i] - before;
      const bool coincides = step.norm() <= tolerance;
      const bool on_line =
          chord.norm() > tolerance && cross(step, chord) <= tolerance * chord.norm();
      const bool between =
          on_line && step.dot(chord) >= 0 && step.dot(chord) <= chord.squaredNorm();
      if (!coincides && !between) continue;
      points.erase(points.begin() + static_cast<std::ptrdiff_t>(i));
      changed = true;
      --i;
    }
  }
  return points;
}

/// The corners of the convex hull, counter-clockwise, by two chains in the order of the abscissa.
std::vector<Point> convex_hull(std::vector<Point> points) {
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Point> hull;
  const auto add = [&](const Point& p, std::size_t least) {
    while (hull.size() >= least && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
      hull.pop_back();
    hull.push_back(p);
  };
  for (const Point& p : points) add(p, 2);
  const std::size_t lower = hull.size() + 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, lower);
  hull.pop_back();
  return hull;
}

Matrix columns(const std::vector<Point>& points) {
  Matrix vertices(2, static_cast<Index>(points.size()));
  Index i = 0;
  for (const Point& p : points) vertices.col(i++) = p;
  return vertices;
}

}  // namespace

SupportOracle support_oracle(const Zonotope& Z) {
  check(Z, "zonotope");
  return [Z](const Vector& d) {
    SupportPoint best{d.dot(Z.c), Z.c};
    for (Index j = 0; j < Z.generators(); ++j) {
      const double part = d.dot(Z.G.col(j));
      best.h += std::abs(part);
      best.x += (part < 0 ? -1.0 : 1.0) * Z.G.col(j);
    }
    return best;
  };
}

// Works in coordinates scaled to the unit square. The stack holds edges whose outer side is not yet
// explored.
Matrix polygon(const SupportOracle& X, double tolerance) {
  ScaledSet set(X, 2, "polygon");
  if (set.is_empty()) return Matrix(2, 0);
  std::vector<Point> corners;
  for (const Point& d : {Point(1, 0), Point(0, 1), Point(-1, 0), Point(0, -1)})
    corners.push_back(set.query(d).x);
  std::vector<Point> found;
  Index queries = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    std::vector<std::pair<Point, Point>> open{{corners[k], corners[(k + 1) % 4]}};
    while (!open.empty()) {
      const auto [p, q] = open.back();
      open.pop_back();
      const Point edge = q - p, normal(edge.y(), -edge.x());
      const double length = edge.norm();
      const SupportPoint beyond =
          length > tolerance && queries++ < 10000 ? set.query(normal / length) : SupportPoint{0, p};
      const Point r = beyond.x;
      if (normal.dot(r - p) <= tolerance * length) {
        found.push_back(p);
        continue;
      }
      open.emplace_back(r, q);  // explored after [p, r]: points are found counter-clockwise
      open.emplace_back(p, r);
    }
  }
  // Points of the boundary are known up to rounding: where two come in the wrong order, the whole
  // set lies beyond their edge, and it is gone around twice.
  return set.restore(columns(strictly_convex(convex_hull(std::move(found)), tolerance)));
}

Matrix polygon(const Zonotope& Z) {
  check(Z, "polygon of a zonotope");
  require_size(Z.dim(), 2, "polygon of a zonotope", "the zonotope");
  Matrix G = merge_parallel_generators(Z).G;
  for (auto g : G.colwise()) {
    if (g.y() < 0 || (g.y() == 0 && g.x() < 0)) g = -g;
  }
  std::vector<Point> edges;
  for (const auto g : G.colwise()) edges.emplace_back(g);
  std::sort(edges.begin(), edges.end(),
            [](const Point& a, const Point& b) { return cross(a, b) > 0; });
  // from the lowest vertex along the edges by increasing angle, then back along their opposites
  Point p = Z.c - G.rowwise().sum();
  if (edges.empty()) return Z.c;
  std::vector<Point> points;
  for (const Point& g : edges) {
    points.push_back(p);
    p += 2 * g;
  }
  const std::size_t half = edges.size();
  for (std::size_t i = 0; i < half; ++i) points.push_back(2 * Z.c - points[i]);
  return columns(points);
}

double area(const Matrix& vertices) {
  double twice = 0;
  for (Index i = 2; i < vertices.cols(); ++i) {
    twice += cross(vertices.col(i - 1) - vertices.col(0), vertices.col(i) - vertices.col(0));
  }
  return twice / 2;
}

}  // namespace cordon::sets
