// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes through support functions: solids with details of any size, thin ones, and support
// functions that are not exact.
#include <algorithm>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/sets/vertices.hpp"
#include "cordon/solvers/polytope.hpp"
#include "random_sets.hpp"

using namespace cordon;
using namespace cordon::sets;
using namespace cordon::test;

namespace {

const Matrix cube{{0, 1, 0, 1, 0, 1, 0, 1}, {0, 0, 1, 1, 0, 0, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}};

/// Hull of finitely many points.
SupportOracle hull_of(const Matrix& points) {
  return [points](const Vector& d) {
    Index best = 0;
    const double h = (d.transpose() * points).maxCoeff(&best);
    return SupportPoint{h, points.col(best)};
  };
}

Matrix normal_matrix(Index rows, Index cols, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Matrix A(rows, cols);
  for (double& a : A.reshaped()) a = normal(random);
  return A;
}

/// The true value lies between bounds that agree to the tolerance.
void check_bounds(const VolumeBounds& found, double truth, double precision = 1e-8) {
  CHECK(found.converged);
  CHECK(found.lower <= truth * (1 + 1e-12));
  CHECK(found.upper >= truth * (1 - 1e-12));
  CHECK(found.upper <= found.lower * (1 + 1e-7));
  CHECK(found.upper == doctest::Approx(truth).epsilon(precision));
}

}  // namespace

TEST_CASE("zonotopes with details of any size") {
  std::mt19937 random(1);
  for (const double detail : {0., 1e-15, 1e-13, 3e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-4}) {
    for (const double thin : {1., .003}) {
      for (int trial = 0; trial < 20; ++trial) {
        CAPTURE(detail);
        CAPTURE(trial);
        Zonotope Z{Vector::Zero(3), normal_matrix(3, 9, random)};
        Z.G.rightCols(4) *= detail;
        Z.G.row(2) *= thin;
        check_bounds(volume(support_oracle(Z)), *volume(Z));
        const Vector scales{{1e8, 1e-8, 1}};  // and sheared
        Zonotope other{Vector{{1e8, 1e-8, -3}},
                       scales.asDiagonal() * Matrix{{1, 2, 0}, {0, 1, 0}, {3, 0, 1}} * Z.G};
        check_bounds(volume(support_oracle(other)), *volume(other));
      }
    }
  }
}

TEST_CASE("many generators") {
  std::mt19937 random(2);
  Zonotope Z{Vector::Ones(3), normal_matrix(3, 30, random)};
  for (Index j = 0; j < 30; ++j) Z.G.col(j) *= std::pow(10, -j / 2.);
  Index queries = 0;
  const SupportOracle counting = [&](const Vector& d) {
    ++queries;
    return support_oracle(Z)(d);
  };
  check_bounds(volume(counting), *volume(Z));
  CHECK(queries < 1700);  // facets that are replaced at once are not asked
}

TEST_CASE("cubes cut or extended by almost nothing") {
  for (double t = 1e-16; t < .5; t *= 10) {
    CAPTURE(t);
    Matrix corner(3, 10), edge(3, 10), roof(3, 9), cloud(3, 32);
    corner << cube.rightCols(7),
        Matrix{{t, 0, 0}, {0, t, 0}, {0, 0, t}};  // without the simplex at the origin
    check_bounds(volume(hull_of(corner)), 1 - t * t * t / 6);
    edge << cube.rightCols(6),
        Matrix{{0, 0, 1, 1}, {t, 0, t, 0}, {0, t, 0, t}};  // without the edge y = z = 0
    check_bounds(volume(hull_of(edge)), 1 - t * t / 2);
    roof << cube, Vector{{.5, .25, 1 + t}};
    check_bounds(volume(hull_of(roof)), 1 + t / 3);
    for (Index j = 0; j < 8; ++j) {  // three points on the edges from each corner
      cloud.middleCols(4 * j, 4) = cube.col(j).replicate(1, 4);
      for (Index i = 0; i < 3; ++i) cloud(i, 4 * j + i + 1) += cube(i, j) > 0 ? -t : t;
    }
    check_bounds(volume(hull_of(cloud)), 1);
  }
}

TEST_CASE("points in one plane and on one line") {
  Matrix grid(3, 125);  // of which only the corners are vertices
  for (Index k = 0; k < 125; ++k) grid.col(k) = Vector{{k % 5 - 2., k / 5 % 5 - 2., k / 25 - 2.}};
  check_bounds(volume(hull_of(grid)), 64, 1e-9);
  const auto somewhere =
      [&](const Vector& d) {  // any of the points that attain the maximum, no vertex where possible
        const Vector values = grid.transpose() * d;
        const double h = values.maxCoeff();
        SupportPoint best{h, {}};
        for (Index k = 0; k < grid.cols(); ++k) {
          if (values[k] < h - 1e-13) continue;
          if (best.x.size() == 0 || grid.col(k).norm() < best.x.norm()) best.x = grid.col(k);
        }
        return best;
      };
  check_bounds(volume(somewhere), 64, 1e-9);
}

TEST_CASE("hulls of random points, thin ones among them, against exact arithmetic") {
  CHECK(rc::check([] {
    const Index count = *rc::gen::inRange<Index>(4, 12);
    Matrix points = arbitrary_matrix(3, count);
    if (*rc::gen::arbitrary<bool>()) {  // pairs of points that are almost one
      const double near = std::pow(10.0, -*rc::gen::inRange(1, 15));
      for (Index j = 1; j < count; j += 2)
        points.col(j) = points.col(j - 1) + near * arbitrary_vector(3);
    }
    const double thin = std::pow(10.0, -*rc::gen::inRange(0, 11));
    points.row(2) *= thin;
    if (*rc::gen::arbitrary<bool>())
      points = Matrix(Matrix{{1, 0, 2}, {0, 1, 3}, {1, 1, 1}} * points);
    const Interval truth = Polytope::from_generators(points).volume();
    const VolumeBounds found = volume(hull_of(points));
    const Vector sizes = points.rowwise().maxCoeff() - points.rowwise().minCoeff();
    const double noise = 1e-12 * sizes.prod();
    RC_ASSERT(found.lower <= found.upper);
    RC_ASSERT(found.lower <= truth.upper * (1 + 1e-12) + noise);
    RC_ASSERT(found.upper >= truth.lower * (1 - 1e-12) - noise);
    RC_ASSERT(!found.converged || found.upper <= found.lower * (1 + 1e-7));
    RC_ASSERT(found.converged ||
              truth.upper <= 1e-3 * sizes.prod());  // only thin and flat sets may stay open
  }));
}

TEST_CASE("a support function that is not exact widens the bounds") {
  for (const double error : {1e-14, 1e-9, 1e-6, 1e-3, .1, .4}) {
    CAPTURE(error);
    const SupportOracle above = [&](const Vector& d) {
      SupportPoint answer = hull_of(cube)(d);
      answer.h += error * d.norm();
      return answer;
    };
    const VolumeBounds found = volume(above);
    CHECK(found.converged == (error <= 1e-9));
    CHECK(found.lower <= 1 + 1e-12);
    CHECK(found.upper >= 1);
    CHECK(found.upper <= std::pow(1 + 20 * error, 3));
    // points beyond what the support function allows: the volume may be that of either
    const SupportOracle below = [&](const Vector& d) {
      SupportPoint answer = hull_of(cube)(d);
      answer.h -= error * d.norm();
      return answer;
    };
    const VolumeBounds contradicted = volume(below);
    CHECK(contradicted.converged == (error <= 1e-9));
    CHECK(contradicted.lower >= 0);
    CHECK(contradicted.lower <= std::pow(1 - 2 * error, 3) * (1 + 1e-12));
    CHECK(contradicted.upper >= 1. / 6 - 1e-9);  // of a simplex of its points
  }
}

TEST_CASE("points that are none of the set's do not end the search for bounds") {
  const VolumeBounds early = volume(hull_of(cube), 1e-7, 4);
  for (const double distance : {1e6, 1e15}) {
    CAPTURE(distance);
    int queries = 0;
    const SupportOracle wild = [&](const Vector& d) {
      SupportPoint answer = hull_of(cube)(d);
      if (++queries > 20) answer.x = distance * d;
      return answer;
    };
    const VolumeBounds found = volume(wild);
    CHECK_FALSE(found.converged);
    CHECK(found.lower >= early.lower);
    CHECK(found.lower <= 1);
    CHECK(found.upper >= 1);
    CHECK(found.upper <= early.upper);
  }
}

TEST_CASE("the limit of queries") {
  const VolumeBounds none = volume(hull_of(cube), 1e-7, 3);
  CHECK_FALSE(none.converged);
  CHECK(none.lower == 0);
  CHECK(none.upper == std::numeric_limits<double>::infinity());
  const VolumeBounds some = volume(hull_of(cube), 1e-7, 4);
  CHECK_FALSE(some.converged);
  CHECK(some.lower > 0);
  CHECK(some.lower < 1);
  CHECK(some.upper > 1);
  CHECK(volume(hull_of(cube), 10, 4).converged == (some.upper <= 11 * some.lower));
}
