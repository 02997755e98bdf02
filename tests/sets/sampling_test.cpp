// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/sampling.hpp"

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "random_sets.hpp"

using namespace cordon;
using namespace cordon::sets;
using namespace cordon::test;

TEST_CASE("the same numbers on every machine") {
  Random random(5489);
  for (int k = 1; k < 10000; ++k) random.unit();
  CHECK(random.unit() == static_cast<double>(9981545732273789042ULL >> 11) /
                             9007199254740992.0);  // C++ [rand.predef]
  const Vector x = random.cube(1000);
  CHECK(x.minCoeff() >= -1);
  CHECK(x.maxCoeff() < 1);
  CHECK(std::abs(x.mean()) < .1);
  CHECK(x.minCoeff() < -.99);
  CHECK(x.maxCoeff() > .99);
}

TEST_CASE("points of a zonotope and of a box with a line") {
  const LineForm Z = make_zonotope(Vector{{1, 2}}, Matrix{{1, 0}, {1, 3}});
  const Matrix points = *sample(Z, 500, 7);
  CHECK(points.cols() == 500);
  CHECK(points.row(0).minCoeff() >= 0);
  CHECK(points.row(0).maxCoeff() <= 2);
  CHECK(points.row(0).maxCoeff() > 1.95);
  CHECK(*sample(Z, 5, 7) == points.leftCols(5));
  CHECK(*sample(Z, 5, 8) != points.leftCols(5));
  const Matrix free = *sample(make_space(2), 500, 7);
  CHECK(free.maxCoeff() <= 10);
  CHECK(free.maxCoeff() > 9.5);
  CHECK(sample(make_point(Vector{{1, 2}}), 3, 1)->col(2) == Vector{{1, 2}});
  CHECK(sample(Z, 0, 1)->cols() == 0);
  CHECK_THROWS_AS(sample(Z, -1, 1), Error);
}

TEST_CASE("hit-and-run fills a constrained set and keeps to it") {
  // the part of [-1,1]² with x1 + x2 = .5 and its line version with a strip
  LineForm X = make_zonotope(Vector::Zero(2), Matrix::Identity(2, 2));
  X.A = Matrix{{1, 1}};
  X.S = Matrix(1, 0);
  X.b = Vector::Constant(1, .5);
  const Matrix points = *sample(X, 400, 3);
  CHECK((points.colwise().sum().array() - .5).abs().maxCoeff() < 1e-12);
  CHECK(points.row(0).minCoeff() >= -.5 - 1e-12);
  CHECK(points.row(0).minCoeff() < -.45);
  CHECK(points.row(0).maxCoeff() > .95);
  CHECK(points.row(0).maxCoeff() <= 1 + 1e-12);
  const Matrix strip = *sample(make_strip(Vector{{1, -1}}, 1, .1), 400, 3);
  const Vector across = strip.row(0) - strip.row(1);
  CHECK((across.array() - 1).abs().maxCoeff() <= .1 + 1e-12);
  CHECK((across.array() - 1).abs().maxCoeff() > .09);
  CHECK(strip.row(0).maxCoeff() - strip.row(0).minCoeff() > 5);
}

TEST_CASE("nothing is sampled from the empty set; a single feasible factor is repeated") {
  CHECK_FALSE(sample(make_empty(2), 5, 1));
  LineForm X = make_zonotope(Vector::Zero(1), Matrix{{1, 1}});
  X.A = Matrix{{1, 1}};
  X.S = Matrix(1, 0);
  X.b = Vector::Constant(1, 3);
  CHECK_FALSE(sample(X, 5, 1));
  X.b[0] = 2;
  const auto corner = sample(X, 5, 1);
  REQUIRE(corner);
  CHECK((corner->array() - 2).abs().maxCoeff() < 1e-9);
  X.A *= 1e-8;  // badly scaled rows
  X.b *= .5e-8;
  CHECK(sample(X, 5, 1));
  X = intersection(make_point(Vector{{1, 2}}), Matrix::Identity(2, 2),
                   make_point(Vector{{1, 2}}));  // rows without factors
  CHECK(sample(X, 1, 1)->col(0) == Vector{{1, 2}});
  CHECK_FALSE(sample(
      intersection(make_point(Vector{{1, 2}}), Matrix::Identity(2, 2), make_point(Vector{{1, 3}})),
      1, 1));
}

TEST_CASE("sampled points are not proven to lie outside") {
  CHECK(rc::check([] {
    const Index n = arbitrary_dim(3);
    const Zonotope X = arbitrary_zonotope(n, Vector::Ones(n)),
                   Y = arbitrary_zonotope(n, Vector::Ones(n));
    const Matrix R = arbitrary_matrix(n, n);
    Random random = arbitrary_random();
    const Zonotope around{R * point_of(X, random), Y.G};
    const LineForm Z = intersection(make_zonotope(X.c, X.G), R, make_zonotope(around.c, around.G));
    const auto points = sample(Z, 4, *rc::gen::arbitrary<std::uint64_t>());
    RC_PRE(points.has_value());
    for (Index k = 0; k < points->cols(); ++k) {
      RC_ASSERT(encloses(X, points->col(k), random));
      RC_ASSERT(encloses(around, R * points->col(k), sizes_of(around) + R.cwiseAbs() * sizes_of(X),
                         random));
    }
  }));
}
