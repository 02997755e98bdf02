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

constexpr GeneratorReduction methods[] = {
    GeneratorReduction::girard, GeneratorReduction::combastel,  GeneratorReduction::pca,
    GeneratorReduction::qr,     GeneratorReduction::yang_scott, GeneratorReduction::adaptive};

/// Are both the same columns up to order and sign?
bool same_columns(const Matrix& A, const Matrix& B, double tolerance) {
  if (A.cols() != B.cols()) return false;
  std::vector<bool> taken(static_cast<std::size_t>(B.cols()), false);
  for (Index i = 0; i < A.cols(); ++i) {
    bool found = false;
    for (Index j = 0; j < B.cols() && !found; ++j) {
      if (taken[static_cast<std::size_t>(j)]) continue;
      if ((A.col(i) - B.col(j)).norm() > tolerance && (A.col(i) + B.col(j)).norm() > tolerance)
        continue;
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
  CHECK(same_columns(reduce_generators(published, 12, GeneratorReduction::pca),
                     Matrix{{.243, .319, -.276, -.517, -.521, .659, -.369, -.03, -.67169339,
                             -1.90302355, -1.29804065, -.00227348},
                            {-.436, .675, -.209, -.474, .252, .037, .817, -.693, 2.57392622,
                             -.9327904, .0213089, -.01921718},
                            {.259, .474, -.76, -.003, -.153, -.637, -.214, -.157, .61627837,
                             1.59586041, -1.32151626, .60563656},
                            {.589, -.198, .371, .652, .757, -.317, .26, -.644, -.21399533,
                             -.65043975, .52482913, 1.52014618}},
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

TEST_CASE(
    "a box is reduced without loss; parallel generators are merged for nothing by the basis") {
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
  // v1 = (.4, .4) in the basis I costs .16, v2 = (.9, .01) only .009, though it is longer
  const Matrix H = reduce_generators(Matrix{{1, 0, .4, .9}, {0, 1, .4, .01}}, 3);
  CHECK(same_columns(H, Matrix{{1.9, 0, .4}, {0, 1.01, .4}}, 1e-12));
}

TEST_CASE("coordinates of very unlike scale keep their accuracy") {
  sets::Random random(5);
  Matrix G(3, 12);
  for (double& x : G.reshaped()) x = random.between(-1, 1);
  G = Matrix(Vector{{1e8, 1, 1e-8}}.asDiagonal() * G);
  for (const GeneratorReduction method : methods) {
    const Matrix H = reduce_generators(G, 3, method);
    for (Index i = 0; i < 3; ++i) {
      CHECK(H.row(i).lpNorm<1>() >= G.row(i).lpNorm<1>() * (1 - 1e-12));
      CHECK(H.row(i).lpNorm<1>() <= G.row(i).lpNorm<1>() * 10);
    }
  }
}

TEST_CASE("flat sets stay flat") {
  sets::Random random(3);
  const Matrix base{{1, 0}, {2, 1}, {-1, 3}, {.5, .5}};
  Matrix factors(2, 12);
  for (double& x : factors.reshaped()) x = random.between(-1, 1);
  CHECK(reduce_generators(base * factors, 6, GeneratorReduction::yang_scott).cols() == 6);
  for (const GeneratorReduction method :
       {GeneratorReduction::yang_scott, GeneratorReduction::qr, GeneratorReduction::adaptive}) {
    const Matrix H = reduce_generators(base * factors, 6, method);
    CHECK(H.cols() <= 6);
    CHECK(linalg::rank(H, 1e-9) == 2);
  }
  // a direction of relative size 1e-12 is below the rank tolerance, but must not be lost
  Matrix thin = base * factors;
  thin.row(3) = thin.row(0);
  thin(3, 11) += 1e-12;
  const Matrix K = reduce_generators(thin, 4);
  const Vector d{{-1, 0, 0, 1}};
  CHECK((K.transpose() * d).lpNorm<1>() >= (thin.transpose() * d).lpNorm<1>() * .9);
  CHECK((K.transpose() * d).lpNorm<1>() < 1e-10);
}

TEST_CASE("room of a last digit in a row of a flat set is kept") {
  sets::Random random(4);
  const Matrix base{{1, 0}, {2, 1}, {-1, 3}, {1, 3}};
  Matrix G = Matrix::Zero(4, 14);
  for (Index j = 0; j < 12; ++j)
    G.col(j) = base * Vector{{random.between(-1, 1), random.between(-1, 1)}};
  G(3, 12) = 3e-16;
  G(3, 13) = 8e-16;
  const Matrix H = reduce_generators(G, 6, GeneratorReduction::yang_scott);
  CHECK(H.cols() <= 6);
  double own = 0;
  for (Index j = 0; j < H.cols(); ++j)
    if (H.col(j).head(3).isZero(0)) own += std::abs(H(3, j));
  CHECK(own >= 1.1e-15);
  CHECK(own < 1e-12);
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

TEST_CASE("axes are not taken from rows of rounding noise") {
  const double noisy[] = {1e-20, 1e-12, 1e-6};
  for (const double noise : noisy) {
    CAPTURE(noise);
    const Matrix G{{noise, noise, noise, -noise}, {1, -1, .5, .25}};
    for (const GeneratorReduction method : {GeneratorReduction::pca, GeneratorReduction::qr}) {
      const Matrix H = reduce_generators(G, 2, method);
      CHECK(H.row(1).lpNorm<1>() == doctest::Approx(2.75).epsilon(1e-12));
      CHECK(H.row(0).lpNorm<1>() >= 4 * noise);
      CHECK(H.row(0).lpNorm<1>() <= 4 * noise * (1 + 1e-12));
    }
  }
}

namespace {

/// Largest width of the coordinates after `steps` of X⁺ = F X ⊕ N, reduced, in units of the
/// unreduced limit Σ |Fʲ N| 1.
double growth(const Matrix& F, const Matrix& N, const Matrix& G0, Index budget,
              GeneratorReduction method, int steps) {
  Vector limit = Vector::Zero(F.rows());
  Matrix D = N;
  for (int k = 0; k < 3000; ++k, D = Matrix(F * D)) limit += D.cwiseAbs().rowwise().sum();
  Matrix G = G0;
  for (int k = 0; k < steps; ++k) {
    Matrix next(F.rows(), G.cols() + N.cols());
    next << F * G, N;
    G = reduce_generators(next, budget, method);
  }
  return G.cwiseAbs().rowwise().sum().cwiseQuotient(limit).maxCoeff();
}

}  // namespace

TEST_CASE("sets of a stable recursion do not grow under the default reduction") {
  // the error of a Kalman gain L for a stable plant: F = A - L, N = [.02 I, -.3 L]
  const Matrix A{{.98, 0, .02}, {0, .96, .02}, {.02, .02, .955}};
  const Matrix L{{.055, 0, .008}, {0, .045, .007}, {.008, .007, .046}};
  const Matrix F = A - L;
  Matrix N(3, 6);
  N << .02 * Matrix::Identity(3, 3), -.3 * L;
  const Matrix G0 = 2 * Matrix::Identity(3, 3);
  CHECK(growth(F, N, G0, 30, GeneratorReduction::yang_scott, 600) >
        1e3);  // which is why it is not the default
  for (const Index budget : {6, 10, 30, 100}) {
    CAPTURE(budget);
    CHECK(growth(F, N, G0, budget, GeneratorReduction::adaptive, 600) < (budget < 30 ? 3 : 1.5));
    CHECK(growth(F, N, G0, budget, GeneratorReduction::qr, 600) < 10);
  }
}
