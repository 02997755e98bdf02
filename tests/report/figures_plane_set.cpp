// SPDX-License-Identifier: GPL-3.0-or-later
// Drawn polygons against exact projections of the same sets.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/polytope.hpp"
#include "experiments/report/plane_set.hpp"

using namespace cordon;
using namespace cordon::report;

namespace {

using Points = std::vector<PlanePoint>;

double extent(const Points& points) {
  double size = 0;
  for (const PlanePoint& p : points) {
    for (const PlanePoint& q : points) size = std::max(size, std::hypot(p.x - q.x, p.y - q.y));
  }
  return size;
}

/// How far a point lies outside of a convex polygon (counter-clockwise), by its edges; of a point
/// or a segment, by the distance.
double beyond(const Points& polygon, double x, double y) {
  if (polygon.size() == 1) return std::hypot(x - polygon[0].x, y - polygon[0].y);
  double worst = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const PlanePoint p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const double dx = q.x - p.x, dy = q.y - p.y, length = std::hypot(dx, dy);
    worst = std::max(worst, (dy * (x - p.x) - dx * (y - p.y)) / length);
    if (polygon.size() > 2) continue;
    const double along = ((x - p.x) * dx + (y - p.y) * dy) / length;
    worst = std::max({worst, along - length, -along});
  }
  return worst;
}

double area(const Points& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const PlanePoint p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    twice += p.x * q.y - q.x * p.y;
  }
  return twice / 2;
}

Matrix random_matrix(Index rows, Index cols, int size = 4) {
  Matrix A(rows, cols);
  for (Index j = 0; j < cols; ++j) {
    for (Index i = 0; i < rows; ++i) A(i, j) = *rc::gen::inRange(-size, size + 1);
  }
  return A;
}

LineForm random_set(Index lines) {
  const Index n = *rc::gen::inRange(2, 5), g = *rc::gen::inRange(0, 7);
  const Index m = *rc::gen::inRange(0, 3) + (lines > 0 ? *rc::gen::inRange(0, 3) : 0);
  const LineForm X{random_matrix(n, lines), random_matrix(n, g), random_matrix(n, 1, 100),
                   random_matrix(m, lines), random_matrix(m, g), random_matrix(m, 1, 3)};
  return X;
}

Polytope exact(const LineForm& X, Index i, Index j) {
  Matrix P = Matrix::Zero(2, X.dim());
  P(0, i) = P(1, j) = 1;
  return Polytope::from(affine_map(X, P, Vector::Zero(2)));
}

Points vertices(const Polytope& P) {
  const Matrix V = P.generators().vertices;
  Points points;
  for (Index k = 0; k < V.cols(); ++k) points.push_back({V(0, k), V(1, k)});
  return points;
}

/// Corners of a convex polygon, counter-clockwise.
Points in_order(Points corners) {
  PlanePoint middle;
  for (const PlanePoint& p : corners) {
    middle.x += p.x / static_cast<double>(corners.size());
    middle.y += p.y / static_cast<double>(corners.size());
  }
  const auto angle = [&](const PlanePoint& p) {
    return std::atan2(p.y - middle.y, p.x - middle.x);
  };
  std::sort(corners.begin(), corners.end(),
            [&](const PlanePoint& p, const PlanePoint& q) { return angle(p) < angle(q); });
  return corners;
}

void check_bounded(const PlaneSet& set, const Polytope& P, bool tight) {
  RC_ASSERT(set.kind == PlaneSet::Kind::bounded);
  const Points corners = vertices(P);
  const double precision = 1e-6 * extent(corners) + 1e-9;
  for (const PlanePoint& p : corners) RC_ASSERT(beyond(set.vertices, p.x, p.y) <= precision);
  if (set.vertices.size() > 2) RC_ASSERT(area(set.vertices) > 0);
  if (!tight) return;
  RC_ASSERT(set.vertices.size() <= corners.size() ||
            extent(set.vertices) <= 1e-9);    // a point may have the width of rounding
  for (const PlanePoint& v : set.vertices) {  // and is one of the exact ones
    RC_ASSERT(std::any_of(corners.begin(), corners.end(), [&](const PlanePoint& p) {
      return std::hypot(p.x - v.x, p.y - v.y) <= precision;
    }));
  }
}

PlaneSet polygon(Points points) { return {PlaneSet::Kind::bounded, std::move(points), {}, 0, 0}; }

SetFrame window(double left, double right, double bottom, double top) {
  return {0, left, right, bottom, top, {}, {}};
}

}  // namespace

TEST_CASE("bounded sets are drawn as their exact projections") {
  CHECK(rc::check([] {
    const LineForm X = random_set(0);
    const Index i = *rc::gen::inRange<Index>(0, X.dim()), j = (i + 1) % X.dim();
    const Polytope P = exact(X, i, j);
    const PlaneSet set = project(X, i, j);
    RC_CLASSIFY(P.is_empty(), "empty");
    if (P.is_empty()) {
      RC_ASSERT(set.kind == PlaneSet::Kind::empty);
      return;
    }
    RC_CLASSIFY(vertices(P).size() == 1, "point");
    RC_CLASSIFY(vertices(P).size() == 2, "segment");
    RC_CLASSIFY(X.constraints() > 0, "constraints");
    check_bounded(set, P, true);
  }));
}

TEST_CASE("units and offsets of the two coordinates are their own") {
  CHECK(rc::check([] {
    LineForm X = random_set(0);
    if (*rc::gen::inRange(0, 3) > 0) {  // most sets with room
      X.G = random_matrix(X.dim(), 8);
      X.S = Matrix(*rc::gen::inRange(0, 3), 0);
      X.A = random_matrix(X.S.rows(), 8);
      X.b = random_matrix(X.A.rows(), 1, 5);
    }
    X.c.setZero();
    const Polytope P = exact(X, 0, 1);
    RC_PRE(!P.is_empty());
    const Points corners = in_order(vertices(P));
    const PlanePoint unit{std::pow(10, *rc::gen::inRange(-90, 91) / 10.0),
                          std::pow(10, *rc::gen::inRange(-90, 91) / 10.0)};
    const PlanePoint offset{std::pow(10, *rc::gen::inRange(0, 9)) - 1,
                            1 - std::pow(10, *rc::gen::inRange(0, 9))};
    X.G.row(0) *= unit.x;
    X.G.row(1) *= unit.y;
    X.c[0] = offset.x * unit.x;
    X.c[1] = offset.y * unit.y;
    PlaneSet set = project(X, 0, 1);
    RC_ASSERT(set.kind == PlaneSet::Kind::bounded);
    for (PlanePoint& p : set.vertices) p = {(p.x - X.c[0]) / unit.x, (p.y - X.c[1]) / unit.y};
    const double rounding = 1e-15 * (std::abs(offset.x) + std::abs(offset.y) + 10),
                 precision = 1e-8 + 8 * rounding;
    for (const PlanePoint& p : corners) RC_ASSERT(beyond(set.vertices, p.x, p.y) <= precision);
    const auto same_extent = [&](auto coordinate) {
      const auto less = [&](const PlanePoint& p, const PlanePoint& q) {
        return p.*coordinate < q.*coordinate;
      };
      const auto drawn = std::minmax_element(set.vertices.begin(), set.vertices.end(), less);
      const auto whole = std::minmax_element(corners.begin(), corners.end(), less);
      RC_ASSERT(std::abs(*drawn.first.*coordinate - *whole.first.*coordinate) <= 1e-7 + rounding);
      RC_ASSERT(std::abs(*drawn.second.*coordinate - *whole.second.*coordinate) <= 1e-7 + rounding);
    };
    same_extent(&PlanePoint::x);
    same_extent(&PlanePoint::y);
    for (const PlanePoint& p : set.vertices)
      RC_ASSERT(beyond(set.vertices, p.x, p.y) <= precision);  // convex
    if (corners.size() > 2 && area(corners) > 1e-3) {
      RC_ASSERT(std::abs(area(set.vertices) / area(corners) - 1) <= 1e-4 + 1e3 * rounding);
    }
  }));
}

TEST_CASE("one coordinate without width, and none") {
  const Matrix A = (Matrix(1, 3) << 1, 1, 0).finished();
  for (const double unit : {1e-9, 1.0, 1e9}) {
    LineForm X{Matrix(2, 0),
               (Matrix(2, 3) << 0, 0, 0, unit, 0, unit).finished(),
               Eigen::Vector2d(1e6, 3),
               Matrix(1, 0),
               A,
               Vector::Zero(1)};
    const PlaneSet upright = project(X, 0, 1), level = project(X, 1, 0);
    REQUIRE(upright.vertices.size() == 2);
    REQUIRE(level.vertices.size() == 2);
    for (const PlanePoint& p : upright.vertices) CHECK(p.x == 1e6);
    CHECK(std::abs(upright.vertices[0].y - upright.vertices[1].y) == doctest::Approx(4 * unit));
    for (const PlanePoint& p : level.vertices) CHECK(p.y == 1e6);
    CHECK(std::abs(level.vertices[0].x - level.vertices[1].x) == doctest::Approx(4 * unit));
    X.G.setZero();
    const PlaneSet point = project(X, 0, 1);
    REQUIRE(point.vertices.size() == 1);
    CHECK(point.vertices[0].y == 3);
  }
  const LineForm huge =
      make_zonotope(Eigen::Vector2d(0, 0), (Matrix(2, 2) << 1e308, 1e308, 1, 0).finished());
  CHECK_THROWS_AS(project(huge, 0, 1), Error);
}

TEST_CASE("with few vertices or directions the polygon still holds the set") {
  CHECK(rc::check([] {
    LineForm X = random_set(0);
    X.G = random_matrix(X.dim(), 7);
    X.A = random_matrix(X.constraints(), 7);
    const Polytope P = exact(X, 0, 1);
    RC_PRE(!P.is_empty());
    const PlaneLimits limits{*rc::gen::inRange<std::size_t>(4, 8),
                             *rc::gen::inRange<std::size_t>(0, 6)};
    const PlaneSet set = project(X, 0, 1, limits);
    RC_ASSERT(set.vertices.size() <= limits.vertices);
    check_bounded(set, P, false);
  }));
}

TEST_CASE("sets with lines are strips or the plane") {
  CHECK(rc::check([] {
    const LineForm X = random_set(*rc::gen::inRange(1, 4));
    const Polytope P = exact(X, 0, 1);
    const PlaneSet set = project(X, 0, 1);
    if (P.is_empty()) {
      RC_ASSERT(set.kind == PlaneSet::Kind::empty);
      return;
    }
    const Index free = P.generators().lines.cols();
    RC_CLASSIFY(free == 0, "bounded");
    RC_CLASSIFY(free == 1, "strip");
    if (free == 2) RC_ASSERT(set.kind == PlaneSet::Kind::plane);
    if (free == 0) check_bounded(set, P, true);
    if (free != 1) return;
    RC_ASSERT(set.kind == PlaneSet::Kind::strip);
    const Vector line = P.generators().lines.col(0).normalized();
    const Vector normal = Eigen::Vector2d(set.normal.x, set.normal.y);
    RC_ASSERT(std::abs(normal.norm() - 1) <= 1e-12);
    RC_ASSERT(std::abs(line.dot(normal)) <= 1e-9);
    const Vector across = Eigen::Vector2d(-line[1], line[0]) *
                          (normal.dot(Eigen::Vector2d(-line[1], line[0])) > 0 ? 1 : -1);
    // a direction that is rounded is not exactly across, so that its support value is infinite: the
    // vertices tell the bounds
    double upper = -1e300, lower = 1e300;
    for (const PlanePoint& p : vertices(P)) {
      upper = std::max(upper, across[0] * p.x + across[1] * p.y);
      lower = std::min(lower, across[0] * p.x + across[1] * p.y);
    }
    const double precision = 1e-7 * (1 + std::abs(upper) + std::abs(lower));
    RC_ASSERT(std::abs(set.upper - upper) <= precision);
    RC_ASSERT(std::abs(set.lower - lower) <= precision);
  }));
}

TEST_CASE("a zonotope: vertices in order, parallel generators as one") {
  const LineForm X = make_zonotope(Eigen::Vector2d(10, 20),
                                   (Matrix(2, 5) << 1, -2, 0, 0, 1, 0, 0, 1, 0, -1).finished());
  const PlaneSet set = project(X, 0, 1);
  REQUIRE(set.vertices.size() == 6);
  const Points expected{{8, 18}, {14, 18}, {14, 20}, {12, 22}, {6, 22}, {6, 20}};
  // starts at a lowest vertex and turns to the left
  CHECK(area(set.vertices) == doctest::Approx(area(expected)));
  for (const PlanePoint& p : expected) CHECK(beyond(set.vertices, p.x, p.y) <= 1e-12);
  CHECK(project(make_point(Eigen::Vector2d(3, 4)), 1, 0).vertices.at(0).x == 4);
  CHECK(project(make_empty(2), 0, 1).kind == PlaneSet::Kind::empty);
  CHECK(project(make_space(2), 0, 1).kind == PlaneSet::Kind::plane);
}

TEST_CASE("fewer vertices: the polygon grows, and by little") {
  Points circle;
  for (int k = 0; k < 200; ++k)
    circle.push_back(
        {std::cos(k * 0.01 * 3.14159265358979), std::sin(k * 0.01 * 3.14159265358979)});
  const Points fewer = with_fewer_vertices(circle, 24);
  CHECK(fewer.size() == 24);
  for (const PlanePoint& p : circle) CHECK(beyond(fewer, p.x, p.y) <= 1e-12);
  CHECK(area(fewer) < 1.03 * area(circle));
  const Points square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  CHECK(with_fewer_vertices(square, 3).size() == 4);  // no edge of a parallelogram can go
  CHECK(with_fewer_vertices({}, 4).empty());
}

TEST_CASE("the window cuts, and says where") {
  Polygon out;
  const Points square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  REQUIRE(cut(polygon(square), window(-1, 5, -1, 5), out));
  CHECK(out.x == std::vector<double>{0, 4, 4, 0});
  CHECK(out.open.empty());
  REQUIRE(cut(polygon(square), window(-1, 2, -1, 5), out));
  CHECK(out.x == std::vector<double>{0, 2, 2, 0});
  CHECK(out.y == std::vector<double>{0, 0, 4, 4});
  CHECK(out.open == std::vector<bool>{false, true, false, false});
  REQUIRE(cut(polygon(square), window(1, 2, 1, 2), out));
  CHECK(out.open == std::vector<bool>(4, true));
  CHECK_FALSE(cut(polygon(square), window(5, 6, 0, 4), out));
  REQUIRE(cut(polygon(square), window(4, 5, -1, 5),
              out));  // an edge on the window is an edge of the set
  CHECK(std::none_of(out.x.begin(), out.x.end(), [](double x) { return x != 4; }));
  REQUIRE(cut(polygon({{0, 0}, {4, 4}}), window(-1, 2, -1, 5), out));
  CHECK(*std::max_element(out.x.begin(), out.x.end()) == 2);
  CHECK(*std::max_element(out.y.begin(), out.y.end()) == 2);
  REQUIRE(cut(polygon({{3, 3}}), window(0, 4, 0, 4), out));
  CHECK(out.x.size() == 1);
  REQUIRE(cut({PlaneSet::Kind::empty, {}, {}, 0, 0}, window(0, 1, 0, 1), out));
  CHECK(out.x.empty());
  REQUIRE(cut({PlaneSet::Kind::plane, {}, {}, 0, 0}, window(0, 1, 0, 2), out));
  CHECK(out.open == std::vector<bool>(4, true));
  CHECK(out.y == std::vector<double>{0, 0, 2, 2});
  REQUIRE(cut({PlaneSet::Kind::strip, {}, {0, 1}, 1, 2}, window(0, 1, 0, 5), out));
  CHECK(out.y == std::vector<double>{1, 2, 2, 1});
  CHECK(out.open == std::vector<bool>{true, false, true, false});
  REQUIRE(cut({PlaneSet::Kind::strip, {}, {0, 1}, -INFINITY, 2}, window(0, 1, 0, 5), out));
  CHECK(out.open == std::vector<bool>{true, true, false, true});
}
