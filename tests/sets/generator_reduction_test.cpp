// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/generator_reduction.hpp"

#include <chrono>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "random_sets.hpp"

using namespace cordon;
using namespace cordon::sets;
using namespace cordon::test;

namespace {

constexpr GeneratorReduction methods[] = {GeneratorReduction::girard, GeneratorReduction::combastel, GeneratorReduction::pca,
                                          GeneratorReduction::yang_scott};

/// Are both the same columns up to order and sign?
bool same_columns(const Matrix& A, const Matrix& B, double tolerance) {
  if (A.cols() != B.cols()) return false;
  std::vector<bool> taken(static_cast<std::size_t>(B.cols()), false);
  for (Index i = 0; i < A.cols(); ++i) {
    bool found = false;
    for (Index j = 0; j < B.cols() && !found; ++j) {
      if (taken[static_cast<std::size_t>(j)]) continue;
      if ((A.col(i) - B.col(j)).norm() > tolerance && (A.col(i) + B.col(j)).norm() > tolerance) continue;
      taken[static_cast<std::size_t>(j)] = found = true;
    }
    if (!found) return false;
  }
  return true;
}

const Matrix published{{.243,  .319, .022,  -.276, .088,  -.019, -.223, .335, -.517, -.521,
                        -.104, .659, -.369, -.051, -.746, .093,  -.247, .119, .206,  -.03},
                       {-.436, .675, -.06, -.209, -.204, -.045, -.008, .34,   -.474, .252,
                        .003,  .037, .817, .235,  .256,  .019,  .214,  -.646, .739,  -.693},
                       {.259, .474,  .067,  -.76,  .37,   .06,  -.042, -.265, -.003, -.153,
                        .053, -.637, -.214, -.202, -.093, .013, .256,  -.636, -.191, -.157},
                       {.589, -.198, -.087, .371, -.462, .059, .162,  .024, .652, .757,
                        .105, -.317, .26,   -.37, -.103, .104, -.075, .058, .054, -.644}};

}  // namespace

TEST_CASE("published reductions") {
  CHECK(same_columns(reduce_generators(published, 12, GeneratorReduction::combastel),
                     Matrix{{.319, -.276, -.517, -.521, .659, -.369, .119, -.03, 2.377, 0, 0, 0},
                            {.675, -.209, -.474, .252, .037, .817, -.646, -.693, 0, 2.559, 0, 0},
                            {.474, -.76, -.003, -.153, -.637, -.214, -.636, -.157, 0, 0, 1.871, 0},
                            {-.198, .371, .652, .757, -.317, .26, .058, -.644, 0, 0, 0, 2.194}},
                     1e-6));
  CHECK(same_columns(reduce_generators(published, 4, GeneratorReduction::girard),
                     Matrix(Vector{{5.187, 6.362, 4.905, 5.451}}.asDiagonal()), 1e-6));
  CHECK(
      same_columns(reduce_generators(published, 12, GeneratorReduction::pca),
                   Matrix{{.243, .319, -.276, -.517, -.521, .659, -.369, -.03, -.67169339, -1.90302355, -1.29804065, -.00227348},
                          {-.436, .675, -.209, -.474, .252, .037, .817, -.693, 2.57392622, -.9327904, .0213089, -.01921718},
                          {.259, .474, -.76, -.003, -.153, -.637, -.214, -.157, .61627837, 1.59586041, -1.32151626, .60563656},
                          {.589, -.198, .371, .652, .757, -.317, .26, -.644, -.21399533, -.65043975, .52482913, 1.52014618}},
                   1e-6));
}

TEST_CASE("six generators in the plane become four") {
  const Matrix G{{-.5, 1.5, .5, 1, 0, 1}, {.5, 1.5, 1, .5, 1, 0}};
  sets::Random random(1);
  for (const GeneratorReduction method : methods) {
    const Matrix H = reduce_generators(G, 4, method);
    CHECK(H.cols() == 4);
    CHECK(is_inside({Vector{{2, 1}}, G}, {Vector{{2, 1}}, H}, random, 1e-12, 200));
  }
}

TEST_CASE("what fits is left alone, but for zero columns") {
  const Matrix G{{1, 0, 2}, {3, 0, 4}};
  for (const GeneratorReduction method : methods) {
    CHECK(reduce_generators(G, 2, method) == Matrix{{1, 2}, {3, 4}});
    CHECK(reduce_generators(Matrix::Zero(2, 9), 2, method).cols() == 0);
    CHECK(reduce_generators(Matrix(0, 5), 0, method).cols() == 0);
    CHECK(reduce_generators(Matrix{{1, -2, 3}}, 1, method).cwiseAbs()(0, 0) == doctest::Approx(6));
    CHECK_THROWS_AS(reduce_generators(G, 1, method), Error);
    CHECK_THROWS_AS(reduce_generators(Matrix::Constant(2, 3, std::nan("")), 2, method), Error);
  }
}

TEST_CASE("a box is reduced without loss; parallel generators are merged for nothing by the basis") {
  Matrix G(3, 9);
  G << Matrix::Identity(3, 3), 2 * Matrix::Identity(3, 3), -.5 * Matrix::Identity(3, 3);
  for (const GeneratorReduction method : methods) {
    CHECK(same_columns(reduce_generators(G, 3, method), 3.5 * Matrix::Identity(3, 3), 1e-12));
  }
  const Matrix basis{{1, 1, 0}, {0, 2, 1}, {1, 0, -1}};
  Matrix parallel(3, 6);
  parallel << basis, -.25 * basis;
  CHECK(same_columns(reduce_generators(parallel, 3), 1.25 * basis, 1e-12));
}

TEST_CASE("the cheapest column goes first") {
  // v1 = (.9, .9) in the basis I costs .81, v2 = (.9, .01) costs .009
  const Matrix H = reduce_generators(Matrix{{1, 0, .9, .9}, {0, 1, .9, .01}}, 3);
  CHECK(same_columns(H, Matrix{{1.9, 0, .9}, {0, 1.01, .9}}, 1e-12));
}

TEST_CASE("flat sets stay flat") {
  sets::Random random(3);
  const Matrix base{{1, 0}, {2, 1}, {-1, 3}, {.5, .5}};
  Matrix factors(2, 12);
  for (double& x : factors.reshaped()) x = random.between(-1, 1);
  const Matrix H = reduce_generators(base * factors, 6);
  CHECK(H.cols() == 6);
  CHECK(linalg::rank(H, 1e-9) == 2);
  // a direction of relative size 1e-12 is below the rank tolerance, but must not be lost
  Matrix thin = base * factors;
  thin.row(3) = thin.row(0);
  thin(3, 11) += 1e-12;
  const Matrix K = reduce_generators(thin, 4);
  const Vector d{{-1, 0, 0, 1}};
  CHECK((K.transpose() * d).lpNorm<1>() >= (thin.transpose() * d).lpNorm<1>() * .9);
  CHECK((K.transpose() * d).lpNorm<1>() < 1e-10);
}

TEST_CASE("a reduction encloses and keeps its budget") {
  CHECK(rc::check([] {
    const Index n = arbitrary_dim();
    const Vector scales = arbitrary_coordinates(n);
    Zonotope Z = arbitrary_zonotope(n, scales);
    if (*rc::gen::inRange(0, 2) == 0) Z = minkowski_sum(Z, arbitrary_zonotope(n, scales));
    const Index budget = n + *rc::gen::inRange<Index>(0, 5);
    Random random = arbitrary_random();
    for (const GeneratorReduction method : methods) {
      const Matrix H = reduce_generators(Z.G, budget, method);
      RC_ASSERT(H.cols() <= budget);
      RC_ASSERT(H.allFinite());
      RC_ASSERT(is_inside({Vector::Zero(n), Z.G}, {Vector::Zero(n), H}, random));
      RC_ASSERT(encloses({Z.c, H}, point_of(Z, random), random));
    }
  }));
}
