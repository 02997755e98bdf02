// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/vertices.hpp"

#include <limits>
#include <random>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "random_sets.hpp"

using namespace cordon;
using namespace cordon::sets;
using namespace cordon::test;

namespace {

/// Hull of finitely many points.
SupportOracle hull_of(const Matrix& points) {
  return [points](const Vector& d) {
    Index best = 0;
    const double h = (d.transpose() * points).maxCoeff(&best);
    return SupportPoint{h, points.col(best)};
  };
}

/// The same columns, starting anywhere, in the same order.
bool same_cycle(const Matrix& A, const Matrix& B, double tolerance) {
  if (A.cols() != B.cols()) return false;
  for (Index shift = 0; shift < A.cols() || shift == 0; ++shift) {
    bool equal = true;
    for (Index i = 0; i < A.cols(); ++i)
      equal = equal && (A.col(i) - B.col((i + shift) % A.cols())).norm() <= tolerance;
    if (equal) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("vertices of a published zonotope") {
  const Zonotope Z{Vector{{1, 2}}, Matrix{{1, 3}, {2, 4}}};
  const Matrix expected{{5, 3, -3, -1}, {8, 4, -4, 0}};  // vertices (3,4), (5,8), (-1,0), (-3,-4)
  const Matrix direct = polygon(Z), queried = polygon(support_oracle(Z));
  CHECK(area(direct) == doctest::Approx(8));
  CHECK(same_cycle(direct, queried, 1e-9));
  for (Index i = 0; i < 4; ++i) {
    double nearest = infinity;
    for (Index j = 0; j < direct.cols(); ++j)
      nearest = std::min(nearest, (direct.col(j) - expected.col(i)).norm());
    CHECK(nearest < 1e-12);
  }
}

TEST_CASE("the enclosed zonotope of Bravo's example has six vertices") {
  const Zonotope Z{Vector::Zero(2), Matrix{{.2812, .1968, .4235}, {.0186, -.2063, -.2267}}};
  const Matrix expected{{.9015, .5079, -.3391, -.9015, -.5079, .3391},
                        {-.4144, -.0018, .4516, .4144, .0018, -.4516}};
  CHECK(same_cycle(polygon(Z), expected, 1e-9));
  CHECK(same_cycle(polygon(support_oracle(Z)), expected, 1e-9));
  CHECK(area(polygon(Z)) == doctest::Approx(.70420268));
}

TEST_CASE("degenerate polygons") {
  const Vector c{{1e8, 3}};
  CHECK(polygon(Zonotope{c, Matrix(2, 0)}).cols() == 1);
  CHECK(polygon(support_oracle({c, Matrix(2, 0)})) == c);
  CHECK(area(polygon(Zonotope{c, Matrix(2, 0)})) == 0);
  for (const Matrix& g :
       {Matrix{{1}, {0}}, Matrix{{0}, {-2}}, Matrix{{1}, {-2}}, Matrix{{1e-6}, {1e7}}}) {
    const Matrix direct = polygon(Zonotope{c, g}), queried = polygon(support_oracle({c, g}));
    CHECK(direct.cols() == 2);
    CHECK(same_cycle(direct, queried, 1e-6));
    CHECK(area(queried) == 0);
  }
  CHECK(polygon([](const Vector&) { return SupportPoint{-infinity, {}}; }).cols() == 0);
  CHECK_THROWS_AS(polygon([](const Vector&) { return SupportPoint{infinity, {}}; }), Error);
  // the maximiser in the middle of an edge is no vertex
  const SupportOracle square = [](const Vector& d) {
    const auto pick = [](double x) { return x > 0 ? 1.0 : x < 0 ? -1.0 : 0.0; };
    return SupportPoint{d.lpNorm<1>(), Vector{{pick(d[0]), pick(d[1])}}};
  };
  const SupportOracle segment = [](const Vector& d) {
    return SupportPoint{std::abs(d[1]), Vector{{0, d[1] > 0 ? 1.0 : d[1] < 0 ? -1.0 : 0.0}}};
  };
  CHECK(same_cycle(polygon(segment), Matrix{{0, 0}, {-1, 1}}, 1e-12));
  CHECK(same_cycle(polygon(square), Matrix{{1, 1, -1, -1}, {-1, 1, 1, -1}}, 1e-12));
}

TEST_CASE("a disc is cut off by an inscribed polygon") {
  const SupportOracle disc = [](const Vector& d) { return SupportPoint{d.norm(), d / d.norm()}; };
  CHECK(area(polygon(disc, 1e-6)) == doctest::Approx(3.14159265358979).epsilon(1e-5));
}

TEST_CASE("polygon by queries equals the polygon of the sorted generators") {
  CHECK(rc::check([] {
    const Vector scales = arbitrary_coordinates(2);
    const Zonotope Z{scales.cwiseProduct(arbitrary_vector(2)),
                     scales.asDiagonal() * arbitrary_matrix(2, *rc::gen::inRange<Index>(0, 9))};
    const Matrix direct = polygon(Z), queried = polygon(support_oracle(Z));
    RC_ASSERT(direct.cols() == queried.cols());
    const Matrix scaled = scales.cwiseInverse().asDiagonal() * direct,
                 other = scales.cwiseInverse().asDiagonal() * queried;
    RC_ASSERT(same_cycle(scaled, other, 1e-7));
    RC_ASSERT(std::abs(area(direct) - *volume(Z)) <= 1e-9 * sizes_of(Z).prod());
  }));
}

TEST_CASE("volumes of solids") {
  const Matrix cube{{0, 1, 0, 1, 0, 1, 0, 1}, {0, 0, 1, 1, 0, 0, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}};
  const Matrix octahedron{{1, -1, 0, 0, 0, 0}, {0, 0, 1, -1, 0, 0}, {0, 0, 0, 0, 1, -1}};
  const auto check_volume = [](const Matrix& points, double expected) {
    const VolumeBounds v = volume(hull_of(points));
    CHECK(v.converged);
    CHECK(v.lower == doctest::Approx(expected).epsilon(1e-8));
    CHECK(v.upper >= v.lower);
    CHECK(v.upper <= v.lower * (1 + 1e-9));
  };
  check_volume(cube, 1);
  check_volume(octahedron, 4. / 3);
  check_volume(1e-8 * cube, 1e-24);
  check_volume(Vector{{1e-8, 1, 1e8}}.asDiagonal() * octahedron, 4. / 3);
  check_volume(cube.leftCols(5), 1. / 3);
  const Matrix shear{{1, 0, 1}, {0, 1, 1}, {1, 1, 2 + 1e-5}};  // oblique and thin
  const VolumeBounds thin = volume(hull_of(shear * cube));
  CHECK(thin.lower == doctest::Approx(1e-5).epsilon(1e-8));
}

TEST_CASE("flat, empty and unbounded solids") {
  // what rounding may hide is not called 0
  const auto flat = [](const Matrix& G) {
    const VolumeBounds v = volume(support_oracle({Vector::Ones(3), G}));
    CHECK(v.lower == 0);
    CHECK(v.converged == (v.upper == 0));
    return v.upper;
  };
  CHECK(flat(Matrix(3, 0)) < 1e-40);
  CHECK(flat(Matrix{{1, 2}, {3, -1}, {1, 1}}) < 1e-11);
  CHECK(flat(Matrix{{1}, {1}, {1}}) < 1e-26);
  CHECK(volume([](const Vector&) { return SupportPoint{-infinity, {}}; }).upper == 0);
  CHECK_THROWS_AS(volume([](const Vector&) { return SupportPoint{infinity, {}}; }), Error);
}

TEST_CASE("a ball: bounds on both sides at the limit of queries") {
  const SupportOracle ball = [](const Vector& d) { return SupportPoint{d.norm(), d / d.norm()}; };
  double gap = 100;
  for (const Index queries : {100, 1000, 10000}) {
    const VolumeBounds v = volume(ball, 1e-9, queries);
    CHECK_FALSE(v.converged);
    CHECK(v.lower <= 4.18879020478639);
    CHECK(v.upper >= 4.18879020478639);
    CHECK(v.upper - v.lower < gap / 3);
    gap = v.upper - v.lower;
  }
}

TEST_CASE("volume by queries equals the determinant formula") {
  CHECK(rc::check([] {
    const Vector scales = arbitrary_coordinates(3);
    Zonotope Z{scales.cwiseProduct(arbitrary_vector(3)),
               scales.asDiagonal() * arbitrary_matrix(3, *rc::gen::inRange<Index>(0, 9))};
    const double exact = *volume(Z), noise = 1e-11 * sizes_of(Z).prod();
    const VolumeBounds v = volume(support_oracle(Z));
    RC_ASSERT(v.lower <= exact * (1 + 1e-8) + noise);
    RC_ASSERT(v.upper >= exact * (1 - 1e-8) - noise);
    RC_ASSERT(v.upper <= exact * (1 + 1e-8) + noise);
  }));
}

TEST_CASE("support points that are known up to rounding do not lead around a polygon twice") {
  std::mt19937 random(5);
  const auto draw = [&](double size) {
    return size * (static_cast<double>(random()) / 2147483648.0 - 1);
  };
  for (int trial = 0; trial < 300; ++trial) {
    CAPTURE(trial);
    Matrix corners(2, 3 + trial % 6);
    for (Index j = 0; j < corners.cols(); ++j) corners.col(j) = Eigen::Vector2d(draw(1), draw(1));
    const auto oracle = [&](double offset, double noise) {
      return [&, offset, noise](const Vector& d) {
        Index best = 0;
        const double h = (d.transpose() * corners).maxCoeff(&best) + d.sum() * offset;
        const Vector x = corners.col(best) + Vector{{offset + draw(noise), offset + draw(noise)}};
        return SupportPoint{h, x};
      };
    };
    const double expected = area(polygon(oracle(0, 0)));
    CHECK(area(polygon(oracle(300, 1e-9))) == doctest::Approx(expected).epsilon(1e-6));
    CHECK(area(polygon(oracle(1e4, 1e-8))) == doctest::Approx(expected).epsilon(1e-5));
  }
}
