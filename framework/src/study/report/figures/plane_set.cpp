// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/report/figures/plane_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cordon/core/linalg.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/set_questions.hpp"

namespace cordon::report {

namespace {

using Point = PlanePoint;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double parallel = 1e-13;          ///< sine of the angle between generators that count as one
constexpr double display_precision = 1e-7;  ///< of the set's size

Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
Point operator*(double s, Point a) { return {s * a.x, s * a.y}; }
double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
double length(Point a) { return std::hypot(a.x, a.y); }

/// Where a line through p along d meets one through q along e.
Point meeting(Point p, Point d, Point q, Point e) { return p + (cross(q - p, e) / cross(d, e)) * d; }

double size_of(const std::vector<Point>& points) {
  double size = 0;
  for (const Point& p : points) size = std::max(size, length(p - points.front()));
  return size;
}

/// Without vertices that repeat their predecessor.
std::vector<Point> distinct(const std::vector<Point>& points) {
  const double rounding = 1e-13 * (points.empty() ? 0 : length(points.front()));
  const double near = 1e-2 * display_precision * size_of(points) + rounding;
  std::vector<Point> kept;
  for (const Point& p : points) {
    if (kept.empty() || length(p - kept.back()) > near) kept.push_back(p);
  }
  while (kept.size() > 1 && length(kept.front() - kept.back()) <= near) kept.pop_back();
  return kept;
}

/// {c + Gξ : ‖ξ‖∞ ≤ 1}: from the lowest vertex up along the generators by their angles, and down on the other side.
std::vector<Point> zonotope(Point center, const Matrix& G) {
  std::vector<Point> generators;
  for (Index k = 0; k < G.cols(); ++k) {
    Point g{G(0, k), G(1, k)};
    if (g.x == 0 && g.y == 0) continue;
    if (g.y < 0 || (g.y == 0 && g.x < 0)) g = -1.0 * g;
    generators.push_back(g);
  }
  std::sort(generators.begin(), generators.end(), [](Point a, Point b) { return std::atan2(a.y, a.x) < std::atan2(b.y, b.x); });
  std::vector<Point> half;
  Point at{}, last{};
  for (const Point& g : generators) at = at - g;
  for (const Point& g : generators) {
    if (half.empty() || std::abs(cross(last, g)) > parallel * length(last) * length(g)) half.push_back(at);
    at = at + 2.0 * g;
    last = g;
  }
  if (half.empty()) return {center};
  std::vector<Point> vertices;
  for (const Point& p : half) vertices.push_back(center + p);
  for (const Point& p : half) vertices.push_back(center - p);
  return distinct(vertices);
}

/// Between an inner polygon of points of the set and an outer one of its supporting lines.
class Sandwich {
 public:
  Sandwich(const LineForm& X, std::size_t max_directions) : X_(X), program_(X.A, X.b), left_(max_directions) {}

  PlaneSet enclose() {
    for (const Point d : {Point{1, 0}, Point{0, 1}, Point{-1, 0}, Point{0, -1}}) {
      supports_.push_back(ask(d));
      if (supports_.back().height == -infinity) return {};
    }
    size_ = std::max(supports_[0].height + supports_[2].height, supports_[1].height + supports_[3].height);
    for (std::size_t i = 0; i < supports_.size(); ++i) measure(i);
    while (left_ > 0 && refine()) --left_;
    std::vector<Point> corners;
    for (std::size_t i = 0; i < supports_.size(); ++i) corners.push_back(center() + corner(i));
    return {PlaneSet::Kind::bounded, distinct(corners), {}, 0, 0};
  }

 private:
  /// The set lies in {directionᵀ(x - c) ≤ height} and touches its edge from `first` to `last`, counter-clockwise.
  struct Support {
    Point direction;
    double height = 0;
    bool touches = false;
    Point first = {}, last = {};
    double open = 0;  ///< how far the corner to the next support lies outside of the inner polygon
  };

  Point center() const { return {X_.c[0], X_.c[1]}; }
  const Support& after(std::size_t i) const { return supports_[(i + 1) % supports_.size()]; }

  Support ask(Point d) {
    const Vector direction = Eigen::Vector2d(d.x, d.y);
    const BoxedProgram::Bound bound = program_.maximum(linalg::product(X_.G.transpose(), direction));
    Support support{d, bound.upper};
    if (bound.xi && bound.solved) {
      const Vector p = linalg::product(X_.G, *bound.xi);
      support.touches = true;
      support.first = support.last = {p[0], p[1]};
    }
    return support;
  }

  /// Where the lines of support i and the next one meet.
  Point corner(std::size_t i) const {
    const Support &a = supports_[i], &b = after(i);
    const double det = cross(a.direction, b.direction);
    return {(a.height * b.direction.y - b.height * a.direction.y) / det,
            (b.height * a.direction.x - a.height * b.direction.x) / det};
  }

  void measure(std::size_t i) {
    Support& a = supports_[i];
    const Support& b = after(i);
    a.open = 0;
    if (!a.touches || !b.touches) return;
    const Point chord = b.first - a.last;
    const double long_enough = length(chord);
    if (long_enough <= display_precision * size_) return;
    a.open = cross(corner(i) - a.last, chord) / long_enough;
  }

  /// Asks along the normal of the chord of the largest corner; false if no corner is worth it.
  bool refine() {
    const auto largest =
        std::max_element(supports_.begin(), supports_.end(), [](const auto& a, const auto& b) { return a.open < b.open; });
    if (!(largest->open > display_precision * size_)) return false;
    const auto i = static_cast<std::size_t>(largest - supports_.begin());
    const Point from = largest->last, to = after(i).first, chord = to - from;
    const Point normal = (1 / length(chord)) * Point{chord.y, -chord.x};
    Support support = ask(normal);
    if (support.height <= dot(normal, from) + display_precision * size_) {  // the chord is an edge
      support.touches = true;
      support.first = from;
      support.last = to;
    }
    supports_.insert(largest + 1, support);
    measure(i);
    measure(i + 1);
    return true;
  }

  const LineForm& X_;
  BoxedProgram program_;
  std::size_t left_;
  double size_ = 0;
  std::vector<Support> supports_;  ///< counter-clockwise
};

PlaneSet strip(const LineForm& X) {
  PlaneSet set;
  set.kind = PlaneSet::Kind::strip;
  const Point along{X.M(0, 0), X.M(1, 0)};
  set.normal = (1 / length(along)) * Point{-along.y, along.x};
  const Vector normal = Eigen::Vector2d(set.normal.x, set.normal.y), g = linalg::product(X.G.transpose(), normal);
  BoxedProgram program(X.A, X.b);
  const double middle = normal.dot(X.c), up = program.maximum(g).upper, down = program.maximum(-g).upper;
  if (up == -infinity || down == -infinity) return {};
  set.upper = middle + up;
  set.lower = middle - down;
  return set;
}

/// {dᵀx ≤ h} of a polygon with flags per edge; the new edge has the flag `open`.
void cut_with(std::vector<Point>& points, std::vector<bool>& flags, Point d, double h, bool open) {
  std::vector<Point> kept;
  std::vector<bool> kept_flags;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point p = points[i], q = points[(i + 1) % points.size()];
    const double at_p = dot(d, p) - h, at_q = dot(d, q) - h;
    if (at_p <= 0) {
      kept.push_back(p);
      kept_flags.push_back(flags[i]);
    }
    if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0)) {
      kept.push_back(p + (at_p / (at_p - at_q)) * (q - p));
      kept_flags.push_back(at_p < 0 ? open : flags[i]);
    } else if (at_p == 0 && at_q > 0) {
      kept_flags.back() = open;
    }
  }
  points = std::move(kept);
  flags = std::move(kept_flags);
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
  PlaneSet set;
  if (flat.constraints() == 0) {
    set.kind = PlaneSet::Kind::bounded;
    set.vertices = zonotope({flat.c[0], flat.c[1]}, flat.G);
  } else {
    set = Sandwich(flat, limits.directions).enclose();
  }
  set.vertices = with_fewer_vertices(std::move(set.vertices), limits.vertices);
  return set;
}

std::vector<PlanePoint> with_fewer_vertices(std::vector<PlanePoint> polygon, std::size_t limit) {
  // Edge i from vertex i to i + 1 goes when its neighbours, made longer, meet: area of the triangle that is added, +∞ if they do
  // not.
  const auto at = [&](std::size_t i) { return polygon[i % polygon.size()]; };
  const auto added = [&](std::size_t i) {
    const std::size_t n = polygon.size();
    const Point p = at(i), q = at(i + 1), before = p - at(i + n - 1), behind = at(i + 2) - q, edge = q - p;
    const double turn = cross(before, behind);
    if (!(turn > 0)) return infinity;
    return std::abs(cross(before, edge) * cross(edge, behind) / turn) / 2;
  };
  std::vector<double> areas(polygon.size());
  for (std::size_t i = 0; i < polygon.size(); ++i) areas[i] = added(i);
  while (polygon.size() > std::max<std::size_t>(limit, 4)) {
    const std::size_t n = polygon.size();
    const auto i = static_cast<std::size_t>(std::min_element(areas.begin(), areas.end()) - areas.begin());
    if (areas[i] == infinity) break;
    const Point p = at(i), q = at(i + 1);
    polygon[i] = meeting(p, p - at(i + n - 1), q, at(i + 2) - q);
    const std::size_t gone = (i + 1) % n;
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(gone));
    areas.erase(areas.begin() + static_cast<std::ptrdiff_t>(gone));
    const std::size_t m = polygon.size(), here = gone < i ? i - 1 : i;
    for (std::size_t k = 0; k < 4; ++k) areas[(here + m + k - 2) % m] = added((here + m + k - 2) % m);
  }
  return polygon;
}

bool cut(const PlaneSet& set, const SetFrame& frame, Polygon& out) {
  out.x.clear();
  out.y.clear();
  out.open.clear();
  if (set.kind == PlaneSet::Kind::empty) return true;
  std::vector<Point> points{
      {frame.left, frame.bottom}, {frame.right, frame.bottom}, {frame.right, frame.top}, {frame.left, frame.top}};
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
