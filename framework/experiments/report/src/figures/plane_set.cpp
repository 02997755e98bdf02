// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/plane_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "figures/plane_points.hpp"

namespace cordon::report {

namespace {

using Point = PlanePoint;

constexpr double parallel = 1e-13;  ///< sine of the angle between generators that count as one
constexpr double display_precision = 1e-7;  ///< of the set's size
constexpr double same_vertex = 1e-10;       ///< of the set's size: vertices that count as one

/// Where a line through p along d meets one through q along e.
Point meeting(Point p, Point d, Point q, Point e) {
  return p + (cross(q - p, e) / cross(d, e)) * d;
}

/// Coordinates in which a set has about the same size along both axes, whatever their units: center
/// + 2^exponent times these.
struct Scaling {
  Point center = {};
  int x = 0, y = 0;  ///< exponents: scaling back and forth is exact

  /// Where a coordinate has the center `middle` and the half width `half`.
  void set_x(double middle, double half) {
    center.x = middle;
    std::frexp(half, &x);
  }
  void set_y(double middle, double half) {
    center.y = middle;
    std::frexp(half, &y);
  }
  Matrix scaled(const Matrix& G) const {
    Matrix scaled = G;
    for (Index k = 0; k < G.cols(); ++k) {
      scaled(0, k) = std::ldexp(G(0, k), -x);
      scaled(1, k) = std::ldexp(G(1, k), -y);
    }
    return scaled;
  }
  Point scaled(Point p) const { return {std::ldexp(p.x, -x), std::ldexp(p.y, -y)}; }
  Point back(Point p) const {
    return {center.x + std::ldexp(p.x, x), center.y + std::ldexp(p.y, y)};
  }
};

/// Without vertices that repeat their predecessor.
std::vector<Point> distinct(const std::vector<Point>& points, double near) {
  std::vector<Point> kept;
  for (const Point& p : points) {
    if (kept.empty() || length(p - kept.back()) > near) kept.push_back(p);
  }
  while (kept.size() > 1 && length(kept.front() - kept.back()) <= near) kept.pop_back();
  return kept;
}

/// Scaled vertices as a set, of which numbers may be too large.
PlaneSet bounded(const std::vector<Point>& scaled, const Scaling& scaling, std::size_t limit) {
  PlaneSet set{PlaneSet::Kind::bounded, {}, {}, 0, 0};
  for (const Point& p : with_fewer_vertices(scaled, limit)) {
    set.vertices.push_back(scaling.back(p));
    if (!std::isfinite(set.vertices.back().x) || !std::isfinite(set.vertices.back().y)) {
      throw Error(Errc::not_finite, "projection: the numbers of the set are too large");
    }
  }
  return set;
}

/// Half of the vertices of {Gξ : ‖ξ‖∞ ≤ 1}: from the lowest one up along the generators by their
/// angles.
std::vector<Point> half_of_zonotope(const Matrix& G) {
  std::vector<Point> generators;
  for (Index k = 0; k < G.cols(); ++k) {
    Point g{G(0, k), G(1, k)};
    if (g.x == 0 && g.y == 0) continue;
    if (g.y < 0 || (g.y == 0 && g.x < 0)) g = -1.0 * g;
    generators.push_back(g);
  }
  std::sort(generators.begin(), generators.end(),
            [](Point a, Point b) { return std::atan2(a.y, a.x) < std::atan2(b.y, b.x); });
  std::vector<Point> half;
  Point at{}, last{};
  for (const Point& g : generators) at = at - g;
  for (const Point& g : generators) {
    if (half.empty() || std::abs(cross(last, g)) > parallel * length(last) * length(g))
      half.push_back(at);
    at = at + 2.0 * g;
    last = g;
  }
  return half;
}

PlaneSet zonotope(const LineForm& X, std::size_t limit) {
  Scaling scaling;
  scaling.set_x(X.c[0], X.G.row(0).lpNorm<1>());
  scaling.set_y(X.c[1], X.G.row(1).lpNorm<1>());
  const std::vector<Point> half = half_of_zonotope(scaling.scaled(X.G));
  if (half.empty()) return bounded({Point{}}, scaling, limit);
  std::vector<Point> vertices = half;
  for (const Point& p : half) vertices.push_back(-1.0 * p);
  return bounded(distinct(vertices, 1e-12), scaling, limit);
}

/// Between an inner polygon of points of the set and an outer one of its supporting lines.
class Sandwich {
 public:
  Sandwich(const LineForm& X, const PlaneLimits& limits)
      : X_(X), program_(X.A, X.b), left_(limits.directions), limit_(limits.vertices) {}

  PlaneSet enclose() {
    std::vector<BoxedProgram::Bound> bounds;
    for (const auto& [row, sign] : {std::pair<Index, double>{0, 1}, {1, 1}, {0, -1}, {1, -1}}) {
      bounds.push_back(axis(row, sign));
      if (bounds.back().upper == -infinity) return {};
    }
    middle_ = {(bounds[0].upper - bounds[2].upper) / 2, (bounds[1].upper - bounds[3].upper) / 2};
    const double x = half_width(bounds[0], bounds[2], 0, middle_.x),
                 y = half_width(bounds[1], bounds[3], 1, middle_.y);
    scaling_.set_x(X_.c[0] + middle_.x, x);
    scaling_.set_y(X_.c[1] + middle_.y, y);
    middle_ = scaling_.scaled(middle_);
    const Point corner = scaling_.scaled(Point{x, y});
    const std::vector<Point> box{
        {-corner.x, -corner.y}, {corner.x, -corner.y}, {corner.x, corner.y}, {-corner.x, corner.y}};
    if (x == 0 || y == 0)
      return bounded(distinct(box, 0), scaling_, limit_);  // a point, or a segment along an axis

    G_ = scaling_.scaled(X_.G);
    const Point c = scaling_.scaled(Point{X_.c[0], X_.c[1]});
    rounding_ = {8 * rounding::unit * (G_.row(0).lpNorm<1>() + std::abs(c.x) + 1),
                 8 * rounding::unit * (G_.row(1).lpNorm<1>() + std::abs(c.y) + 1)};
    if (!std::isfinite(rounding_.x + rounding_.y))
      throw Error(Errc::not_finite, "projection: the numbers of the set are too large");
    const Point axes[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (std::size_t q = 0; q < 4; ++q)
      supports_.push_back(support(axes[q], bounds[q], q % 2 == 0 ? corner.x : corner.y));
    for (std::size_t i = 0; i < 4; ++i) measure(i);
    while (left_ > 0 && refine()) --left_;
    return bounded(outer(box), scaling_, limit_);
  }

 private:
  /// In scaled coordinates: the set lies in {directionᵀx ≤ height} and touches its edge from
  /// `first` to `last`, counter-clockwise.
  struct Support {
    Point direction;
    double height = 0;
    bool touches = false;
    Point first = {}, last = {};
    double open = 0;  ///< how far the corner to the next support lies outside of the inner polygon
  };

  /// Of a coordinate up or down. The solver's tolerances are absolute, so that it is asked for
  /// numbers near 1.
  BoxedProgram::Bound axis(Index row, double sign) {
    int exponent = 0;
    std::frexp(X_.G.row(row).lpNorm<1>(), &exponent);
    Vector g = X_.G.row(row);
    for (double& x : g) x = sign * std::ldexp(x, -exponent);
    BoxedProgram::Bound bound = program_.maximum(g);
    bound.upper = std::ldexp(bound.upper, exponent);
    return bound;
  }

  /// Of a coordinate; 0 if what is left is rounding.
  double half_width(const BoxedProgram::Bound& up, const BoxedProgram::Bound& down, Index row,
                    double middle) const {
    const double half = up.upper / 2 + down.upper / 2;
    const double terms = X_.G.row(row).lpNorm<1>() + std::abs(X_.c[row]) + std::abs(middle);
    return half > 1e-12 * terms ? half : 0;
  }

  const Support& after(std::size_t i) const { return supports_[(i + 1) % supports_.size()]; }

  Support support(Point d, const BoxedProgram::Bound& bound, double height) const {
    Support support{d, height};
    if (bound.xi && bound.solved) {
      const Vector p = linalg::product(G_, *bound.xi);
      support.touches = true;
      support.first = support.last = Point{p[0], p[1]} - middle_;
    }
    return support;
  }

  Support ask(Point d) {
    const Vector direction = Eigen::Vector2d(d.x, d.y);
    const BoxedProgram::Bound bound = program_.maximum(linalg::transposed_product(G_, direction));
    return support(d, bound, bound.upper - dot(d, middle_));
  }

  /// Measures the corner where the lines of support i and the next one meet.
  void measure(std::size_t i) {
    Support& a = supports_[i];
    const Support& b = after(i);
    a.open = 0;
    if (!a.touches || !b.touches) return;
    const Point chord = b.first - a.last;
    const double turn = cross(a.direction, b.direction), long_enough = length(chord);
    if (turn <= parallel || long_enough <= display_precision) return;
    const Point corner{(a.height * b.direction.y - b.height * a.direction.y) / turn,
                       (b.height * a.direction.x - a.height * b.direction.x) / turn};
    a.open = cross(corner - a.last, chord) / long_enough;
  }

  /// Asks along the normal of the chord of the largest corner; false if no corner is worth it.
  bool refine() {
    const auto largest =
        std::max_element(supports_.begin(), supports_.end(),
                         [](const auto& a, const auto& b) { return a.open < b.open; });
    if (!(largest->open > display_precision)) return false;
    const auto i = static_cast<std::size_t>(largest - supports_.begin());
    const Point from = largest->last, to = after(i).first, chord = to - from;
    const Point normal = (1 / length(chord)) * Point{chord.y, -chord.x};
    if (cross(largest->direction, normal) <= parallel ||
        cross(normal, after(i).direction) <= parallel) {
      largest->open = 0;  // points that are known too inexactly show no further direction
      return true;
    }
    Support support = ask(normal);
    if (support.height <= dot(normal, from) + display_precision) {  // the chord is an edge
      support.touches = true;
      support.first = from;
      support.last = to;
    }
    supports_.insert(largest + 1, support);
    measure(i);
    measure(i + 1);
    return true;
  }

  /// The box within the supporting lines, all moved outwards by what rounding may cost.
  std::vector<Point> outer(std::vector<Point> points) const {
    for (Point& p : points)
      p = p + Point{std::copysign(rounding_.x, p.x), std::copysign(rounding_.y, p.y)};
    const std::vector<Point> box = points;
    std::vector<bool> flags(points.size(), false);
    for (const Support& s : supports_) {
      const Point d = s.direction;
      const double outwards = std::abs(d.x) * rounding_.x + std::abs(d.y) * rounding_.y;
      if (d.x != 0 && d.y != 0) cut_with(points, flags, d, s.height + outwards, false);
    }
    points = distinct(points, std::max({same_vertex, 4 * rounding_.x, 4 * rounding_.y}));
    return points.empty() ? box : points;
  }

  const LineForm& X_;
  BoxedProgram program_;
  std::size_t left_, limit_;
  Scaling scaling_;
  Matrix G_;                       ///< scaled
  Point middle_;                   ///< of the box without c, scaled
  Point rounding_;                 ///< bound of the rounding errors of heights and vertices, scaled
  std::vector<Support> supports_;  ///< counter-clockwise
};

PlaneSet strip(const LineForm& X) {
  PlaneSet set;
  set.kind = PlaneSet::Kind::strip;
  const Point along{X.M(0, 0), X.M(1, 0)};
  set.normal = (1 / length(along)) * Point{-along.y, along.x};
  const Vector normal = Eigen::Vector2d(set.normal.x, set.normal.y),
               g = linalg::transposed_product(X.G, normal);
  BoxedProgram program(X.A, X.b);
  const double middle = normal.dot(X.c), up = program.maximum(g).upper,
               down = program.maximum(-g).upper;
  if (up == -infinity || down == -infinity) return {};
  set.upper = middle + up;
  set.lower = middle - down;
  return set;
}

}  // namespace

PlaneSet project(const LineForm& X, Index i, Index j, const PlaneLimits& limits) {
  Matrix P = Matrix::Zero(2, X.dim());
  P(0, i) = P(1, j) = 1;
  const LineForm flat = eliminate_lines(affine_map(X, P, Vector::Zero(2)));
  if (flat.lines() == 2) {
    PlaneSet set;
    set.kind = is_empty(flat) == Answer::yes ? PlaneSet::Kind::empty : PlaneSet::Kind::plane;
    return set;
  }
  if (flat.lines() == 1) return strip(flat);
  return flat.constraints() == 0 ? zonotope(flat, limits.vertices)
                                 : Sandwich(flat, limits).enclose();
}

std::vector<PlanePoint> with_fewer_vertices(std::vector<PlanePoint> polygon, std::size_t limit) {
  // Edge i from vertex i to i + 1 goes when its neighbours, made longer, meet: area of the triangle
  // that is added, +∞ if they do not.
  const auto at = [&](std::size_t i) { return polygon[i % polygon.size()]; };
  const auto added = [&](std::size_t i) {
    const std::size_t n = polygon.size();
    const Point p = at(i), q = at(i + 1), before = p - at(i + n - 1), behind = at(i + 2) - q,
                edge = q - p;
    const double turn = cross(before, behind);
    if (!(turn > 0)) return infinity;
    return std::abs(cross(before, edge) * cross(edge, behind) / turn) / 2;
  };
  std::vector<double> areas(polygon.size());
  for (std::size_t i = 0; i < polygon.size(); ++i) areas[i] = added(i);
  while (polygon.size() > std::max<std::size_t>(limit, 4)) {
    const std::size_t n = polygon.size();
    const auto i =
        static_cast<std::size_t>(std::min_element(areas.begin(), areas.end()) - areas.begin());
    if (areas[i] == infinity) break;
    const Point p = at(i), q = at(i + 1);
    polygon[i] = meeting(p, p - at(i + n - 1), q, at(i + 2) - q);
    const std::size_t gone = (i + 1) % n;
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(gone));
    areas.erase(areas.begin() + static_cast<std::ptrdiff_t>(gone));
    const std::size_t m = polygon.size(), here = gone < i ? i - 1 : i;
    for (std::size_t k = 0; k < 4; ++k)
      areas[(here + m + k - 2) % m] = added((here + m + k - 2) % m);
  }
  return polygon;
}

bool cut(const PlaneSet& set, const SetFrame& frame, Polygon& out) {
  out.x.clear();
  out.y.clear();
  out.open.clear();
  if (set.kind == PlaneSet::Kind::empty) return true;
  std::vector<Point> points{{frame.left, frame.bottom},
                            {frame.right, frame.bottom},
                            {frame.right, frame.top},
                            {frame.left, frame.top}};
  std::vector<bool> flags(points.size(), true);
  if (set.kind == PlaneSet::Kind::strip) {
    cut_with(points, flags, set.normal, set.upper, false);
    cut_with(points, flags, -1.0 * set.normal, -set.lower, false);
  } else if (set.kind == PlaneSet::Kind::bounded) {
    points = set.vertices;
    flags.assign(points.size(), false);
    cut_with(points, flags, {1, 0}, frame.right, true);
    cut_with(points, flags, {0, 1}, frame.top, true);
    cut_with(points, flags, {-1, 0}, -frame.left, true);
    cut_with(points, flags, {0, -1}, -frame.bottom, true);
  }
  for (const Point& p : points) {
    out.x.push_back(p.x);
    out.y.push_back(p.y);
  }
  if (std::find(flags.begin(), flags.end(), true) != flags.end()) out.open = flags;
  return !points.empty();
}

}  // namespace cordon::report
