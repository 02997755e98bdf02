// SPDX-License-Identifier: GPL-3.0-or-later
// Strips that repeat what a set says already: equal, proportional and dependent rows, outputs
// without noise, sets without interior. What is left of a direction then is rounding, from which
// nothing may be concluded. The points are made of integers and powers of two, so that they lie in
// the exact intersection.
#include <doctest/doctest.h>

#include "cordon/sets/generator_reduction.hpp"
#include "cordon/sets/outward.hpp"
#include "cordon/sets/strip.hpp"
#include "random_sets.hpp"

using namespace cordon;
using namespace cordon::sets;
using namespace cordon::test;

namespace {

constexpr StripMethod methods[] = {StripMethod::box, StripMethod::hull, StripMethod::segment,
                                   StripMethod::bravo, StripMethod::volume};

Zonotope point(const Vector& x) { return {x, Matrix(x.size(), 0)}; }
Zonotope no_noise() { return point(Vector(0)); }

/// The measurement z = C x, without noise.
std::optional<Zonotope> measured(const Zonotope& Z, const Matrix& C, const Vector& x,
                                 StripMethod method) {
  return correct(Z, C, C * x, Matrix(C.rows(), 0), no_noise(), method);
}

bool holds(const std::optional<Zonotope>& Z, const Vector& x, const Vector& sizes) {
  Random random(7);
  return Z && encloses(*Z, x, sizes, random, 1e-9, 40);
}

Vector integers(Index n, int most) {
  Vector x(n);
  for (double& entry : x) entry = *rc::gen::inRange(-most, most + 1);
  return x;
}
Matrix integers(Index rows, Index cols, int most) {
  Matrix A(rows, cols);
  for (Index j = 0; j < cols; ++j) A.col(j) = integers(rows, most);
  return A;
}

/// Powers of two from 2⁻²⁰ to 2²⁰.
Vector arbitrary_powers(Index n) {
  Vector s(n);
  for (double& value : s) value = std::ldexp(1.0, *rc::gen::inRange(-20, 21));
  return s;
}

/// A set and a point of it, both exact in doubles, and units for outputs.
struct Case {
  Zonotope Z;
  Vector x, units;
};

Case arbitrary_case(Index largest_dim = 8) {
  const Index n = arbitrary_dim(largest_dim), g = *rc::gen::inRange<Index>(0, 10);
  Matrix G = integers(n, g, 4);
  switch (*rc::gen::inRange(0, 5)) {
    case 0: {  // without interior
      const Index r = *rc::gen::inRange<Index>(0, n);
      G = integers(n, r, 2) * integers(r, g, 2);
      break;
    }
    case 1:  // parallel generators
      for (Index j = 1; j < g; j += 2) G.col(j) = G.col(j - 1) * *rc::gen::inRange(-2, 3);
      break;
    case 2:  // long and short generators
      G = Matrix(G * arbitrary_powers(g).asDiagonal());
      break;
    default:
      break;
  }
  Case test{{integers(n, 3), G}, {}, Vector::Ones(n)};
  if (*rc::gen::inRange(0, 2) == 0) {
    test.units = arbitrary_powers(n);
    test.Z = {test.units.cwiseProduct(test.Z.c), test.units.asDiagonal() * G};
  }
  test.x = test.Z.c + test.Z.G * (integers(g, 2) / 2);
  return test;
}

/// Rows that repeat earlier ones, multiples of them (by thirds as well), their sums, and new ones.
Matrix arbitrary_rows(Index p, const Vector& units) {
  Matrix C(p, units.size());
  for (Index i = 0; i < p; ++i) {
    const Index other = i == 0 ? 0 : *rc::gen::inRange<Index>(0, i);
    switch (i == 0 ? 3 : *rc::gen::inRange(0, 5)) {
      case 0:
        C.row(i) = C.row(other);
        break;
      case 1:
        C.row(i) = C.row(other) * *rc::gen::element(-3.0, -1.0, 2.0, 1.0 / 3, 1e-6, 1e6);
        break;
      case 2:
        C.row(i) = C.row(i - 1) + *rc::gen::inRange(-2, 3) * C.row(other);
        break;
      default:
        C.row(i) = integers(units.size(), 3).cwiseQuotient(units);
        break;
    }
  }
  return C;
}

}  // namespace

TEST_CASE("a sum that is measured twice without noise") {
  const Zonotope box{Vector::Zero(2), Matrix::Identity(2, 2)};
  const Vector x{{.5, -.5}};
  const Matrix C{{1, 1}};
  for (const StripMethod method : methods) {
    CAPTURE(static_cast<int>(method));
    const auto once = measured(box, C, x, method);
    REQUIRE(holds(once, x, Vector::Ones(2)));
    const auto twice = measured(*once, C, x, method);
    REQUIRE(holds(twice, x, Vector::Ones(2)));
    CHECK(holds(measured(*twice, C, x, method), x, Vector::Ones(2)));
    CHECK((interval_hull(*twice).upper - Vector::Ones(2)).norm() < 1e-10);
    CHECK(holds(measured(box, Matrix{{1, 1}, {1, 1}}, x, method), x, Vector::Ones(2)));
    CHECK(holds(measured(box, Matrix{{1, 1}, {-3, -3}}, x, method), x, Vector::Ones(2)));
  }
}

TEST_CASE("a coordinate of which rounding is left only") {
  // after the first row, x₁ is known: its generators are rounding errors, and no direction
  const Zonotope Z{Vector{{0, 0, 0}}, Matrix{{1, .5, .3}, {.7, 1, -.3}, {.1, .6, 1}}};
  const Vector x = Z.G * Vector{{1, -1, 1}};
  for (const double factor : {3.0, 5.0, .1, 7e-5, 1 / 3.0}) {
    for (const StripMethod method : methods) {
      CAPTURE(factor);
      CAPTURE(static_cast<int>(method));
      const Matrix C{{factor, 0, 0}, {1, 0, 0}, {.3, 0, 0}};
      CHECK(holds(measured(Z, C, x, method), x, Vector::Ones(3)));
      auto X = measured(Z, C.topRows(1), x, method);
      REQUIRE(holds(X, x, Vector::Ones(3)));
      X = measured(*X, C.bottomRows(1), x, method);
      CHECK(holds(X, x, Vector::Ones(3)));
    }
  }
}

TEST_CASE("a map turns what is flat by rounding into a coordinate") {
  const Matrix A{{.3, .1, 0}, {.1, -.7, .2}, {.2, .4, .9}}, C{{.3, .1, 0}}, first{{1, 0, 0}};
  const Zonotope Z{Vector{{0, 0, 0}}, Matrix{{1, .5, .3}, {.7, 1, -.3}, {.1, .6, 1}}};
  const Vector x = Z.G * Vector{{1, -1, 1}}, next = A * x;
  for (const StripMethod method : methods) {
    CAPTURE(static_cast<int>(method));
    const auto known = measured(Z, C, x, method);
    REQUIRE(holds(known, x, Vector::Ones(3)));
    const MappedZonotope nothing[] = {{Matrix(3, 0), no_noise()}};
    const Zonotope mapped = affine_sum(*known, A, Vector::Zero(3), nothing);
    CHECK(holds(measured(mapped, first, next, method), next, Vector::Ones(3)));
  }
}

TEST_CASE("a singular map of a set with interior") {
  const Matrix A{{.3, .6, 0}, {.1, .2, 0}, {.2, .4, .9}}, B{{.1, -.3, 0}, {1, 0, 0}, {0, 0, 1}},
      first{{1, 0, 0}};
  const Zonotope Z{Vector{{0, 0, 0}}, Matrix{{1, .5, .3}, {.7, 1, -.3}, {.1, .6, 1}}};
  const Vector x = Z.G * Vector{{1, -1, 1}}, next = B * (A * x);
  for (const StripMethod method : methods) {
    CAPTURE(static_cast<int>(method));
    const MappedZonotope nothing[] = {{Matrix(3, 0), no_noise()}};
    const Zonotope flat = affine_sum(Z, A, Vector::Zero(3), nothing),
                   turned = affine_sum(flat, B, Vector::Zero(3), nothing);
    CHECK(holds(measured(turned, first, next, method), next, Vector::Ones(3)));
  }
}

TEST_CASE("points of a set in a strip lie in the result") {
  CHECK(rc::check([] {
    const Case test = arbitrary_case();
    const Matrix C = arbitrary_rows(1, test.units);
    const double sigma = *rc::gen::element(0.0, 0.0, .5, 2.0),
                 d = C.row(0).dot(test.x) + sigma * *rc::gen::element(-1, 0, 1);
    for (const StripMethod method : methods) {
      const auto X = intersect_strip(test.Z, C.row(0).transpose(), d, sigma, method);
      RC_ASSERT(holds(X, test.x, sizes_of(test.Z)));
    }
  }));
}

TEST_CASE("points that explain dependent outputs survive their corrections") {
  CHECK(rc::check([] {
    const Case test = arbitrary_case();
    const Index p = *rc::gen::inRange<Index>(1, 7), q = *rc::gen::element<Index>(0, 0, 1, 2);
    const Matrix C = arbitrary_rows(p, test.units), T = integers(p, q, 2);
    const Vector v = integers(q, 2) / 2;
    Zonotope V{Vector::Zero(q), Matrix::Identity(q, q)};
    if (*rc::gen::inRange(0, 3) == 0) V = point(v);
    const Vector z = C * test.x + T * v;
    for (const StripMethod method : methods) {
      std::optional<Zonotope> X = test.Z;
      for (int k = 0; k < 3 && X; ++k) X = correct(*X, C, z, T, V, method);
      RC_ASSERT(holds(X, test.x, sizes_of(test.Z)));
      std::optional<Zonotope> Y = test.Z;
      for (int k = 0; k < 3 && Y; ++k) Y = sets::outward::correct(*Y, C, z, T, V, method);
      RC_ASSERT(holds(Y, test.x, sizes_of(test.Z)));
    }
  }));
}

TEST_CASE("the truth of a plant without noise survives steps of prediction and correction") {
  CHECK(rc::check([] {
    Case test = arbitrary_case(6);
    const Index n = test.Z.dim(), p = *rc::gen::inRange<Index>(1, n + 2);
    const Matrix scale = test.units.asDiagonal(), inverse = test.units.cwiseInverse().asDiagonal();
    Matrix A = integers(n, n, 2) / *rc::gen::element(1.0, 2.0, 3.0, 10.0);
    if (*rc::gen::inRange(0, 3) == 0) A = Matrix::Identity(n, n);
    if (*rc::gen::inRange(0, 3) == 0) A.row(n - 1) = A.row(0) / 3;  // singular
    A = Matrix(scale * A * inverse);
    const Matrix C = arbitrary_rows(p, test.units);
    const MappedZonotope nothing[] = {{Matrix(n, 0), no_noise()}};
    for (const StripMethod method : methods) {
      std::optional<Zonotope> X = test.Z;
      Vector x = test.x, sizes = sizes_of(test.Z);
      for (int k = 0; k < 4; ++k) {
        X = correct(*X, C, C * x, Matrix(p, 0), no_noise(), method);
        RC_ASSERT(holds(X, x, sizes));
        X->G = reduce_generators(X->G, 2 * n + 1, GeneratorReduction::girard);
        X = affine_sum(*X, A, Vector::Zero(n), nothing);
        x = A * x;
        sizes = A.cwiseAbs() * sizes + Vector::Constant(n, 1e-300);
      }
    }
  }));
}
