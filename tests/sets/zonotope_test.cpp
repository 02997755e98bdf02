// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/zonotope.hpp"

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/sets/generator_reduction.hpp"
#include "random_sets.hpp"

using namespace cordon;
using namespace cordon::sets;
using namespace cordon::test;

TEST_CASE("volume, hull and support of published zonotopes") {
  const Zonotope Z{Vector{{-4, 1}}, Matrix{{-3, -2, -1}, {2, 3, 4}}};
  CHECK(*volume(Z) == doctest::Approx(80));
  CHECK(*volume({Z.c, reduce_generators(Z.G, 2, GeneratorReduction::pca)}) ==
        doctest::Approx(122.81621368214661));
  const Box hull = interval_hull(Z);
  CHECK((hull.lower - Vector{{-10, -8}}).norm() < 1e-12);
  CHECK((hull.upper - Vector{{2, 10}}).norm() < 1e-12);

  const Zonotope Y{Vector{{2, 1}}, Matrix{{4, 2, -2}, {1, 3, 7}}};
  CHECK(support(Y, Vector{{1, 0}}) == doctest::Approx(10));
  CHECK(support(Y, Vector{{-1, 0}}) == doctest::Approx(6));
  CHECK(support(Y, Vector{{0, 1}}) == doctest::Approx(12));
  CHECK(support(Y, Vector{{0, -1}}) == doctest::Approx(10));

  const Zonotope X{Vector{{1, 2}}, Matrix{{1, 3}, {2, 4}}};
  CHECK(*volume(X) == doctest::Approx(8));
  CHECK(support(X, Vector{{1, 1}}) == doctest::Approx(13));
  CHECK(support(X, Vector{{-1, -1}}) == doctest::Approx(7));
}

TEST_CASE("redundant generators") {
  const Zonotope Z = merge_parallel_generators(
      Zonotope{Vector::Zero(2), Matrix{{1, 0, 2, -3, 4}, {2, 0, 4, -6, 1}}});
  CHECK(Z.G == Matrix{{6, 4}, {12, 1}});
  CHECK(drop_zero_generators({Vector::Zero(2), Matrix{{0, 1, 0}, {0, 0, 1e-300}}}).G ==
        Matrix{{1, 0}, {0, 1e-300}});
  CHECK(merge_parallel_generators(Zonotope{Vector::Zero(2), Matrix{{1, 1}, {0, 1e-9}}})
            .generators() == 2);
  CHECK(merge_parallel_generators(Zonotope{Vector::Zero(2), Matrix(2, 0)}).generators() == 0);
  CHECK(merge_parallel_generators(Zonotope{Vector::Zero(2), Matrix{{1e8, 1e8}, {1e-9, -1e-9}}})
            .generators() == 2);
  CHECK(merge_parallel_generators(Zonotope{Vector::Zero(2), Matrix{{.1, .7}, {.3, 2.1}}})
            .generators() == 1);
}

TEST_CASE("volume of degenerate zonotopes and its limit") {
  CHECK(*volume({Vector::Zero(1), Matrix{{1, -2, .5}}}) == doctest::Approx(7));
  CHECK(*volume({Vector::Zero(2), Matrix{{1, 2}, {2, 4}}}) == 0);
  CHECK(*volume({Vector::Zero(3), Matrix::Ones(3, 2)}) == 0);
  CHECK(*volume({Vector(0), Matrix(0, 0)}) == 1);
  CHECK(*volume({Vector::Zero(3), Matrix::Identity(3, 3) * 1e-8}) == doctest::Approx(8e-24));
  CHECK_FALSE(volume({Vector::Zero(10), Matrix::Ones(10, 30)}));
  CHECK(volume({Vector::Zero(2), Matrix::Ones(2, 5)}, 10));
  CHECK_FALSE(volume({Vector::Zero(2), Matrix::Ones(2, 5)}, 9));
}

TEST_CASE("hull of equal sets is the set; of points their segment") {
  const Zonotope Z{Vector{{1, 2}}, Matrix{{1, 3, 0}, {2, 4, 0}}},
      permuted{Vector{{1, 2}}, Matrix{{-3, 1}, {-4, 2}}};
  CHECK(convex_hull(Z, Z).G == Z.G);
  CHECK(*volume(convex_hull(Z, permuted)) == doctest::Approx(8));
  CHECK(convex_hull(Z, permuted).generators() == 2);
  const Zonotope segment =
      convex_hull(Zonotope{Vector{{0, 0}}, Matrix(2, 0)}, Zonotope{Vector{{2, 4}}, Matrix(2, 0)});
  CHECK(segment.c == Vector{{1, 2}});
  CHECK(segment.G.cwiseAbs() == Matrix{{1}, {2}});
}

TEST_CASE("interval map of a point with a negative coordinate") {
  const Zonotope Y = interval_map(Zonotope{Vector{{-2, 0}}, Matrix{{1}, {0}}},
                                  IntervalMatrix(Matrix{{1, 0}}, Matrix{{.5, 9}}));
  CHECK(interval_hull(Y).lower[0] == doctest::Approx(-4.5));  // mid: [-3,-1], spread .5 (|-2| + 1)
  CHECK(interval_hull(Y).upper[0] == doctest::Approx(.5));
}

TEST_CASE("hull and support are upper bounds for the numbers as stored") {
  const Zonotope Z{Vector::Constant(1, .1), Matrix{{.1, .2, .3, 1e-17}}};
  CHECK(interval_hull(Z).upper[0] >= .7);
  CHECK(support(Z, Vector::Ones(1)) >= .7);
  CHECK(support(Z, Vector::Ones(1)) < .7 + 1e-14);
  const Zonotope point{Vector::Constant(1, .1), Matrix::Zero(1, 2)};
  CHECK(interval_hull(point).lower[0] == .1);
  CHECK(interval_hull(point).upper[0] == .1);
}

TEST_CASE("ill-fitting arguments") {
  const Zonotope Z{Vector{{1, 2}}, Matrix{{1, 3}, {2, 4}}},
      bad{Vector{{1, std::nan("")}}, Matrix(2, 0)};
  CHECK_THROWS_AS(affine_map(Z, Matrix::Ones(2, 3), Vector::Zero(2)), Error);
  CHECK_THROWS_AS(minkowski_sum(Z, Zonotope{Vector::Zero(3), Matrix(3, 0)}), Error);
  CHECK_THROWS_AS(interval_hull(bad), Error);
  CHECK_THROWS_AS(support(Z, Vector::Zero(3)), Error);
  CHECK_THROWS_AS(check(Zonotope{Vector::Zero(2), Matrix(3, 1)}, "zonotope"), Error);
}

TEST_CASE("every operation on zonotopes encloses") {
  CHECK(rc::check([] {
    const Index n = arbitrary_dim(), m = arbitrary_dim(4);
    const Vector scales = arbitrary_coordinates(n);
    const Zonotope X = arbitrary_zonotope(n, scales), Y = arbitrary_zonotope(n, scales);
    const Matrix T = arbitrary_matrix(m, n), radius = arbitrary_matrix(m, n).cwiseAbs();
    const Vector t = arbitrary_vector(m);
    const Zonotope image = affine_map(X, T, t), sum = minkowski_sum(X, Y), hull = convex_hull(X, Y),
                   product = cartesian_product(X, Y),
                   spread = interval_map(X, IntervalMatrix(T, radius)),
                   merged = merge_parallel_generators(X), dropped = drop_zero_generators(X);
    const Box box = interval_hull(X);
    Random random = arbitrary_random();
    RC_ASSERT(is_inside(X, hull, random) && is_inside(Y, hull, random));
    RC_ASSERT(is_inside(X, merged, random) && is_inside(merged, X, random));
    RC_ASSERT(is_inside(X, dropped, random) && is_inside(dropped, X, random));
    for (int k = 0; k < 6; ++k) {
      const Vector x = point_of(X, random), y = point_of(Y, random),
                   sizes = T.cwiseAbs() * sizes_of(X) + t.cwiseAbs();
      RC_ASSERT(encloses(image, T * x + t, sizes.cwiseMax(1e-300), random));
      RC_ASSERT(encloses(sum, x + y, random));
      const double part = random.unit();
      RC_ASSERT(encloses(hull, part * x + (1 - part) * y, random));
      RC_ASSERT(encloses(product, (Vector(2 * n) << x, y).finished(), random));
      const Matrix A = T + radius.cwiseProduct(random.cube(m * n).reshaped(m, n));
      RC_ASSERT(encloses(spread, A * x, random));
      const Vector d = direction_for(sizes_of(X), random);
      RC_ASSERT(d.dot(x) <= support(X, d) + 1e-14 * d.cwiseAbs().dot(sizes_of(X)));
      RC_ASSERT(((box.lower - 1e-14 * sizes_of(X)).array() <= x.array()).all());
      RC_ASSERT((x.array() <= (box.upper + 1e-14 * sizes_of(X)).array()).all());
    }
  }));
}

TEST_CASE("the hull is at most the sum of both differences and no worse than pairing in order") {
  CHECK(rc::check([] {
    const Index n = arbitrary_dim(3);
    const Zonotope X = arbitrary_zonotope(n, Vector::Ones(n));
    const Zonotope Y{X.c, X.G.rowwise().reverse()};  // the same set, generators in another order
    const Zonotope hull = convex_hull(X, Y);
    Random random = arbitrary_random();
    RC_ASSERT(
        is_inside(hull, X, random, 1e-7));  // twins of nearly parallel generators may be confused
  }));
}

TEST_CASE("the volume bound is a bound and is reached by boxes") {
  CHECK(volume_bound({Vector::Zero(2), Matrix{{2, 0}, {0, 3}}}) == doctest::Approx(24));
  CHECK(volume_bound({Vector::Zero(2), Matrix{{1, 1}, {1, -1}}}) ==
        doctest::Approx(8));  // the interval hull has 16
  CHECK(rc::check([] {
    const Index n = arbitrary_dim(4);
    const Vector scales = arbitrary_coordinates(n);
    const Zonotope Z = arbitrary_zonotope(n, scales);
    RC_ASSERT(volume_bound(Z) >= *volume(Z) - 1e-9 * sizes_of(Z).prod());
  }));
}
