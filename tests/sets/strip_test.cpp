// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/strip.hpp"

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/sets/generator_reduction.hpp"
#include "random_sets.hpp"

using namespace cordon;
using namespace cordon::sets;
using namespace cordon::test;

namespace {

Zonotope zonotope(std::initializer_list<double> c,
                  std::initializer_list<std::initializer_list<double>> rows) {
  Zonotope Z{Vector(static_cast<Index>(c.size())),
             Matrix(static_cast<Index>(rows.size()),
                    rows.size() ? static_cast<Index>(rows.begin()->size()) : 0)};
  Index i = 0;
  for (double value : c) Z.c[i++] = value;
  i = 0;
  for (const auto& row : rows) {
    Index j = 0;
    for (double value : row) Z.G(i, j++) = value;
    ++i;
  }
  return Z;
}

constexpr StripMethod methods[] = {StripMethod::box, StripMethod::hull, StripMethod::segment,
                                   StripMethod::bravo, StripMethod::volume};

}  // namespace

TEST_CASE("Bravo's example: the third generator gives the smallest enclosure") {
  const Zonotope Z = zonotope({0, 0}, {{.2812, .1968, .4235}, {.0186, -.2063, -.2267}});
  const Vector rho{{1, -1}};
  CHECK(*volume(Z) == doctest::Approx(.70420268).epsilon(1e-9));
  for (const StripMethod method : {StripMethod::bravo, StripMethod::volume}) {
    const Zonotope X = *intersect_strip(Z, rho, 1, .1, method);
    CHECK(*volume(X) == doctest::Approx(.07036519840049223).epsilon(1e-9));
    CHECK((X.c - Vector{{.6513380498308212, -.3486619501691787}}).norm() < 1e-9);
    CHECK(X.generators() == 3);
    CHECK((interval_hull(X).upper - X.c -
           Vector{{.11015862811442634 + .06575436788680403 + .06513380498308213,
                   .11015862811442634 + .06575436788680408 + .03486619501691787}})
              .norm() < 1e-9);
  }
}

TEST_CASE("strip recursion of a system with two states") {
  const Matrix A{{0, -.5}, {1, 1}}, C{{-2, 1}}, T = Matrix::Identity(1, 1);
  const Zonotope W = zonotope({0, 0}, {{-.12}, {.02}}), V = zonotope({0}, {{.2}});
  const double y[] = {
      0.0234670727523143,  -4.328236471896203,  -4.1973096745991345, -1.9546081148402012,
      0.0983604258227819,  1.1666132024783362,  1.107317638717911,   0.4263920687095986,
      -0.009268218571361,  -0.3069527304071071, -0.1292621672249405, -0.0195793311301101,
      -0.0751745657276915, 0.0774426557519688,  0.2618198630568284,  -0.0222441951122745,
      0.0464232298590576,  -0.1385809053684645, 0.0876767710448164,  -0.109466733731803};
  const auto last_hull = [&](StripMethod method) {
    Zonotope X =
        *correct(zonotope({0, 0}, {{3, 0}, {0, 3}}), C, Vector::Constant(1, y[0]), T, V, method);
    for (int k = 1; k < 20; ++k) {
      X = minkowski_sum(affine_map(X, A, Vector::Zero(2)), W);
      X = *correct(X, C, Vector::Constant(1, y[k]), T, V, method);
      X.G = reduce_generators(X.G, 40, GeneratorReduction::girard);
    }
    return interval_hull(X);
  };
  const Box segment = last_hull(StripMethod::segment);
  CHECK((segment.lower - Vector{{-0.1252836718233518, -0.3590605415736482}}).norm() < 1e-6);
  CHECK((segment.upper - Vector{{0.1755077905850537, 0.3031460898598283}}).norm() < 1e-6);
  for (const StripMethod method : {StripMethod::bravo, StripMethod::volume}) {
    const Box hull = last_hull(method);
    CHECK((hull.lower - Vector{{-0.1148743303581211, -0.3792153944480451}}).norm() < 1e-6);
    CHECK((hull.upper - Vector{{0.141125669641879, 0.212784605551955}}).norm() < 1e-6);
  }
}

TEST_CASE("strips in one dimension are intersected exactly") {
  for (const StripMethod method : {StripMethod::bravo, StripMethod::volume}) {
    const Zonotope X = *intersect_strip(zonotope({0}, {{5}}), Vector::Ones(1), 5, 1, method);
    CHECK(interval_hull(X).lower[0] == doctest::Approx(4));
    CHECK(interval_hull(X).upper[0] == doctest::Approx(5));
    const Zonotope point = *intersect_strip(zonotope({0}, {{4}}), Vector::Ones(1), 5, 1, method);
    CHECK(interval_hull(point).lower[0] == doctest::Approx(4));
    CHECK(interval_hull(point).upper[0] == doctest::Approx(4));
  }
  for (const StripMethod method : methods)
    CHECK(!intersect_strip(zonotope({0}, {{3}}), Vector::Ones(1), 5, 1, method));
}

TEST_CASE("degenerate strips and sets") {
  const Zonotope Z = zonotope({1, 2}, {{1, .5}, {0, 1}}), point = zonotope({1, 2}, {{}, {}});
  const Vector zero = Vector::Zero(2), first = Vector::Unit(2, 0);
  for (const StripMethod method : methods) {
    CAPTURE(static_cast<int>(method));
    CHECK(intersect_strip(Z, zero, .5, 1, method)->G == Z.G);
    CHECK(!intersect_strip(Z, zero, 2, 1, method));
    CHECK(!intersect_strip(Z, first, 2.6, .05, method));
    CHECK(intersect_strip(Z, first, 2.6, .2, method));
    CHECK(intersect_strip(Z, first, 1, 3, method)->G == Z.G);
    CHECK(intersect_strip(point, first, 1.5, .5, method)->c == point.c);
    CHECK(!intersect_strip(point, first, 1.5, .25, method));
    const Zonotope plane = *intersect_strip(Z, first, 1.25, 0, method);
    CHECK(plane.c[0] == doctest::Approx(1.25));
    CHECK(plane.G.row(0).cwiseAbs().maxCoeff() <
          1e-14);  // σ grows by the rounding error of d - ρᵀc
    // the same plane again, off by the rounding errors of the first cut: not empty, nothing changes
    const Zonotope again = *intersect_strip(plane, first, 1.25 + 1e-15, 0, method);
    CHECK((interval_hull(again).upper - interval_hull(plane).upper).norm() < 1e-12);
    CHECK((interval_hull(again).lower - interval_hull(plane).lower).norm() < 1e-12);
    CHECK_THROWS_AS(intersect_strip(Z, first, 0, -1, method), Error);
    CHECK_THROWS_AS(intersect_strip(Z, Vector::Ones(3), 0, 1, method), Error);
    CHECK_THROWS_AS(intersect_strip(Z, first, std::nan(""), 1, method), Error);
  }
}

TEST_CASE("a repeated equality changes nothing") {
  const Zonotope Z{Vector{{.1, .2, .3}}, Matrix{{1, .5, 0, 2}, {0, 1, -.3, 1}, {.2, 0, 1, -1}}};
  const Vector rho{{.1, -.7, .3}};
  for (const StripMethod method : methods) {
    const Zonotope once = *intersect_strip(Z, rho, .2, 0, method);
    // the second cut sees rounding errors only: no direction may be taken from them
    const Zonotope twice = *intersect_strip(once, rho / 3, .2 / 3, 0, method);
    CHECK((interval_hull(twice).upper - interval_hull(once).upper).norm() < 1e-12);
    CHECK((interval_hull(twice).lower - interval_hull(once).lower).norm() < 1e-12);
    CHECK(intersect_strip(once, rho, .2 + 1e-13, 0, method));
    CHECK(!intersect_strip(once, rho, .2 + 1e-9, 0, method));
  }
}

TEST_CASE("a wide strip leaves the zonotope when no other member of the family is smaller") {
  const Zonotope Z{Vector::Zero(2), Matrix::Identity(2, 2)};
  for (const StripMethod method : {StripMethod::bravo, StripMethod::volume}) {
    CHECK(intersect_strip(Z, Vector::Ones(2), 0, 1.9, method)->G == Z.G);
    CHECK(*volume(*intersect_strip(Z, Vector::Ones(2), 0, .9, method)) == doctest::Approx(3.6));
  }
}

TEST_CASE("the segment gain has the smallest F-radius of the family") {
  const Zonotope Z = zonotope({0, 0, 0}, {{1, .5, 0, 2}, {0, 1, -.3, 1}, {.2, 0, 1, -1}});
  const Vector rho{{1, -.5, 2}};
  const double best = f_radius(*intersect_strip(Z, rho, .3, .4, StripMethod::segment));
  for (const StripMethod other : {StripMethod::bravo, StripMethod::volume})
    CHECK(best <= f_radius(*intersect_strip(Z, rho, .3, .4, other)));
  CHECK(best < f_radius(Z));
}

TEST_CASE(
    "the box gain is that of the smallest F-radius for a box, however many generators it is made "
    "of") {
  const Vector rho{{1, -.5}};
  const Zonotope box = zonotope({0, 0}, {{2, 0}, {0, 1}});
  const Zonotope pieces = zonotope({0, 0}, {{.5, .5, .5, .5, 0, 0}, {0, 0, 0, 0, .5, .5}});
  const Box expected = interval_hull(*intersect_strip(box, rho, .3, .4, StripMethod::segment));
  const Box found = interval_hull(*intersect_strip(pieces, rho, .3, .4, StripMethod::box));
  CHECK((found.upper - expected.upper).norm() < 1e-12);
  CHECK((found.lower - expected.lower).norm() < 1e-12);
  const Box segment = interval_hull(*intersect_strip(pieces, rho, .3, .4, StripMethod::segment));
  CHECK((segment.upper - segment.lower).sum() > 1.05 * (found.upper - found.lower).sum());
}

TEST_CASE("the hull gain gives the smallest interval hull of the family") {
  CHECK(rc::check([] {
    const Index n = arbitrary_dim(4);
    const Zonotope Z = arbitrary_zonotope(n, Vector::Ones(n));
    const Vector rho = arbitrary_vector(n);
    const double sigma = .01 + std::abs(arbitrary_number()),
                 offset = rho.dot(Z.c) + arbitrary_number();
    const auto best = intersect_strip(Z, rho, offset, sigma, StripMethod::hull);
    if (!best) return;
    const auto radii = [](const Zonotope& X) { return Vector(X.G.cwiseAbs().rowwise().sum()); };
    const Vector most = radii(*best), room = 1e-9 * sizes_of(Z);
    RC_ASSERT((most.array() <= (radii(Z) + room).array()).all());
    for (const StripMethod other : methods) {
      RC_ASSERT(
          (most.array() <= (radii(*intersect_strip(Z, rho, offset, sigma, other)) + room).array())
              .all());
    }
  }));
}

TEST_CASE("the unit of a state changes nothing") {
  CHECK(rc::check([] {
    const Index n = arbitrary_dim(4), p = arbitrary_dim(2);
    const Zonotope Z{arbitrary_vector(n), arbitrary_matrix(n, *rc::gen::inRange<Index>(1, 9))},
        V{Vector::Zero(p), Matrix::Identity(p, p)};
    const Matrix C = arbitrary_matrix(p, n);
    Random random = arbitrary_random();
    const Vector z = C * point_of(Z, random);
    Vector units = Vector::Ones(n);
    units[*rc::gen::inRange<Index>(0, n)] = *rc::gen::element(1e3, 1e-3, 2.54);
    const Matrix to = units.asDiagonal(), back = units.cwiseInverse().asDiagonal();
    for (const StripMethod method : methods) {
      const auto X = correct(Z, C, z, Matrix::Identity(p, p), V, method),
                 Y = correct(affine_map(Z, to, Vector::Zero(n)), C * back, z,
                             Matrix::Identity(p, p), V, method);
      RC_ASSERT(X && Y);
      // of several λ that are equally good rounding may choose another one
      if (method == StripMethod::bravo || method == StripMethod::volume) continue;
      const Box expected = interval_hull(*X),
                found = interval_hull(affine_map(*Y, back, Vector::Zero(n)));
      RC_ASSERT(
          ((expected.upper - found.upper).cwiseAbs().array() <= 1e-9 * sizes_of(Z).array()).all());
      RC_ASSERT(
          ((expected.lower - found.lower).cwiseAbs().array() <= 1e-9 * sizes_of(Z).array()).all());
    }
  }));
  // with one best generator the smallest volume is determined as well
  const Zonotope Z =
      zonotope({.3, -.2, .1}, {{1, .5, .1, 2, .7}, {.2, 1, -.3, 1, .4}, {.2, .1, 1, -1, .3}});
  const Vector rho{{1, -.5, 2}}, units{{1, 1e3, 1}};
  for (const StripMethod method : methods) {
    CAPTURE(static_cast<int>(method));
    const Zonotope X = *intersect_strip(Z, rho, .3, .4, method),
                   Y = *intersect_strip({units.cwiseProduct(Z.c), units.asDiagonal() * Z.G},
                                        rho.cwiseQuotient(units), .3, .4, method);
    REQUIRE(X.generators() == Y.generators());
    CHECK((units.cwiseInverse().asDiagonal() * Y.G - X.G).cwiseAbs().maxCoeff() < 1e-9);
    CHECK((Y.c.cwiseQuotient(units) - X.c).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("in three dimensions the linear program beats the generators' directions") {
  // the best λ is e1, which no generator is parallel to
  const Zonotope Z = zonotope({0, 0, 0}, {{1, 1, 1, 1}, {1, -1, 0, 0}, {0, 0, 1, -1}});
  const Vector rho = Vector::Unit(3, 0);
  const double by_generators = *volume(*intersect_strip(Z, rho, 0, .1, StripMethod::bravo));
  const Zonotope best = *intersect_strip(Z, rho, 0, .1, StripMethod::volume);
  CHECK(*volume(best) < .9 * by_generators);
  CHECK(interval_hull(best).upper[0] == doctest::Approx(.1));
}

TEST_CASE(
    "beyond the limit of subsets, the smallest volume is no worse than among parallel strips") {
  // 20,349 and 26,334 subsets of five generators
  for (const Index g : {21, 22}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      CAPTURE(g);
      CAPTURE(seed);
      Random random(seed);
      Zonotope Z{Vector::Zero(6), Matrix(6, g)};
      for (Index j = 0; j < g; ++j) Z.G.col(j) = random.cube(6);
      const Vector rho = random.cube(6);
      const double whole = *volume(Z),
                   bravo = *volume(*intersect_strip(Z, rho, .3, .2, StripMethod::bravo));
      const Zonotope best = *intersect_strip(Z, rho, .3, .2, StripMethod::volume);
      CHECK(*volume(best) <= bravo * (1 + 1e-9));
      CHECK(*volume(best) < whole);
      CHECK(f_radius(best) > f_radius(*intersect_strip(Z, rho, .3, .2, StripMethod::segment)));
    }
  }
}

TEST_CASE("volume of the enclosures: volume ≤ bravo ≤ Z") {
  CHECK(rc::check([] {
    const Index n = arbitrary_dim(4);
    const Zonotope Z = arbitrary_zonotope(n, Vector::Ones(n));
    const Vector rho = arbitrary_vector(n);
    const double sigma = std::abs(arbitrary_number()), offset = arbitrary_number();
    const auto bravo = intersect_strip(Z, rho, rho.dot(Z.c) + offset, sigma, StripMethod::bravo);
    const auto smallest =
        intersect_strip(Z, rho, rho.dot(Z.c) + offset, sigma, StripMethod::volume);
    RC_ASSERT(bravo.has_value() == smallest.has_value());
    if (!bravo) return;
    const double scale = 1e-9 * sizes_of(Z).prod();  // flat sets: rounding errors only
    RC_ASSERT(*volume(*bravo) <= *volume(Z) + scale);
    RC_ASSERT(*volume(*smallest) <= *volume(*bravo) + scale);
  }));
}

TEST_CASE("points of a zonotope in a strip lie in the enclosure") {
  CHECK(rc::check([] {
    const Index n = arbitrary_dim();
    const Vector scales = arbitrary_coordinates(n);
    const Zonotope Z = arbitrary_zonotope(n, scales);
    const Vector rho = arbitrary_vector(n).cwiseQuotient(scales);
    Random random = arbitrary_random();
    const Vector x = point_of(Z, random);
    const double sigma = *rc::gen::inRange(0, 3) == 0 ? 0.0 : std::abs(arbitrary_number());
    for (const StripMethod method : methods) {
      const auto X =
          intersect_strip(Z, rho, rho.dot(x) + sigma * random.between(-1, 1), sigma, method);
      RC_ASSERT(X.has_value());
      RC_ASSERT(X->generators() <= Z.generators() + 1);
      RC_ASSERT(encloses(*X, x, sizes_of(Z), random));
    }
  }));
}

TEST_CASE("a coordinate as wide as the smallest numbers is no reason to fail") {
  const double least = std::numeric_limits<double>::denorm_min();
  const Zonotope Z{Vector{{5, 5, 0}}, Matrix{{5, 1, 0, 0}, {0, 5, 1, 0}, {0, 0, 0, 4 * least}}};
  for (const StripMethod method : methods) {
    CAPTURE(static_cast<int>(method));
    const auto cut = intersect_strip(Z, Vector{{1, 0, 0}}, 4.2, 0.05, method);
    REQUIRE(cut.has_value());
    CHECK(cut->G.allFinite());
    CHECK(cut->c.allFinite());
    CHECK(std::abs(cut->c[0] - 4.2) <= cut->G.row(0).lpNorm<1>());
  }
}

TEST_CASE("states that explain an output survive its correction") {
  CHECK(rc::check([] {
    const Index n = arbitrary_dim(), p = arbitrary_dim(3), q = *rc::gen::inRange<Index>(0, 4);
    const Vector scales = arbitrary_coordinates(n);
    const Zonotope Z = arbitrary_zonotope(n, scales), V = arbitrary_zonotope(q, Vector::Ones(q));
    const Matrix C = arbitrary_matrix(p, n) * scales.cwiseInverse().asDiagonal(),
                 T = arbitrary_matrix(p, q);
    Random random = arbitrary_random();
    const Vector x = point_of(Z, random), z = C * x + T * point_of(V, random);
    for (const StripMethod method : methods) {
      const auto X = correct(Z, C, z, T, V, method);
      RC_ASSERT(X.has_value());
      RC_ASSERT(encloses(*X, x, sizes_of(Z), random));
    }
  }));
}
