// SPDX-License-Identifier: GPL-3.0-or-later
// The parts that outward rounding is made of, against rational arithmetic.
#include "cordon/sets/outward.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "cordon/core/line_bounds.hpp"
#include "cordon/sets/sampling.hpp"
#include "cordon/solvers/outward_questions.hpp"
#include "rational_set.hpp"

using namespace cordon;
using test::RationalSet;
using Support = test::RationalSet::Support;

namespace {

Matrix random_matrix(sets::Random& random, Index rows, Index cols) {
  Matrix A(rows, cols);
  for (double& a : A.reshaped()) a = random.between(-1, 1);
  return A;
}

}  // namespace

TEST_CASE("a box made of bounds encloses them exactly") {
  sets::Random random(1);
  for (int k = 0; k < 20000; ++k) {
    const double scale = std::pow(2.0, std::round(random.between(-30, 30)));
    double lower = random.between(-1, 1) * scale, upper = random.between(-1, 1);
    if (lower > upper) std::swap(lower, upper);
    const LineForm X = make_box({Vector{{lower}}, Vector{{upper}}});
    const mpq_class center(X.c[0]), radius(X.generators() ? X.G(0, 0) : 0.0);
    REQUIRE(center + radius >= mpq_class(upper));
    REQUIRE(center - radius <= mpq_class(lower));
  }
}

TEST_CASE("bounded lines leave the set as it is, to the last bit") {
  sets::Random random(2);
  int bounded = 0;
  for (int k = 0; k < 40; ++k) {
    const Index n = 2, l = 1 + k % 3, g = 2, m = l + k % 2;
    LineForm X{random_matrix(random, n, l), random_matrix(random, n, g),
               random_matrix(random, n, 1), random_matrix(random, m, l),
               random_matrix(random, m, g), Vector(m)};
    if (k % 4 == 0) X.S.row(0).tail(l - 1).setZero();  // a row with one line
    if (k % 5 == 0) X.S *= 1e-9;
    X.b = X.S * random_matrix(random, l, 1) + X.A * (0.5 * random_matrix(random, g, 1));
    const BoundedLines Y = bound_lines(X);
    CHECK(Y.set.lines() == 0);
    CHECK(static_cast<Index>(Y.pivots.size()) == l);
    bounded += Y.set.lines() == 0;
    const cordon::sets::Reduced reduced = cordon::sets::outward::enclose_without_lines(X);
    for (int direction = 0; direction < 3; ++direction) {
      const Vector d = random_matrix(random, n, 1);
      const Support before = RationalSet::of(X).support(d),
                    after = RationalSet::of(Y.set).support(d);
      CHECK(before.kind == after.kind);
      if (before.kind != Support::finite) continue;
      CHECK(before.value == after.value);
      const Support outer = RationalSet::of(reduced.set).support(d);
      CHECK(outer.kind == Support::finite);
      CHECK(outer.value >= before.value);
      CHECK(outer.value.get_d() <=
            before.value.get_d() + 1e-9 * (1 + std::abs(before.value.get_d())));
      CHECK(mpq_class(cordon::outward::support(X, d)) >= before.value);
    }
  }
  CHECK(bounded == 40);
}

TEST_CASE("lines that no rows determine stay, and their directions are unbounded") {
  // two lines, one row: δ₁ + 0.1 δ₂ = ξ; x = (δ₁ + 0.1 δ₂, δ₂)
  const LineForm X{Matrix{{1, 0.1}, {0, 1}}, Matrix::Zero(2, 1), Vector::Zero(2),
                   Matrix{{1, 0.1}},         Matrix{{-1.0}},     Vector::Zero(1)};
  CHECK(bound_lines(X).set.lines() == 2);
  CHECK(cordon::outward::support(X, Vector{{0, 1}}) == infinity);
  CHECK(cordon::outward::support(X, Vector{{1, 0}}) == 1);
  // dᵀM cancels in double arithmetic, not in truth: (0.1, -1) · (3, 0.3) is 1.7e-17
  const LineForm line{Matrix{{3.0}, {0.1 * 3}},
                      Matrix(2, 0),
                      Vector::Zero(2),
                      Matrix(0, 1),
                      Matrix(0, 0),
                      Vector(0)};
  CHECK(cordon::outward::support(line, Vector{{0.1, -1}}) == infinity);
}

TEST_CASE("reduced generators enclose exactly: ordinary, flat and badly scaled") {
  using sets::GeneratorReduction;
  sets::Random random(3);
  for (const GeneratorReduction method :
       {GeneratorReduction::yang_scott, GeneratorReduction::pca, GeneratorReduction::girard,
        GeneratorReduction::combastel}) {
    for (int k = 0; k < 60; ++k) {
      const Index n = 1 + k % 5, g = n + 1 + k % 9;
      Matrix G = random_matrix(random, n, g);
      if (k % 4 == 1 && n > 1)
        G = random_matrix(random, n, n - 1) * random_matrix(random, n - 1, g);
      if (k % 4 == 2) {
        for (Index i = 0; i < n; ++i) G.row(i) *= std::pow(10.0, random.between(-8, 8));
      }
      if (k % 4 == 3) G.col(0) = Vector::Unit(n, 0) * 1e-17;
      const Matrix H = cordon::sets::outward::reduce_generators(G, n + k % 2, method);
      CHECK(H.cols() <= n + k % 2);
      const Vector sizes = G.cwiseAbs().rowwise().sum().cwiseMax(1e-300);
      for (int direction = 0; direction < 8; ++direction) {
        const Vector d = random.cube(n).cwiseQuotient(sizes);
        const RationalSet before = RationalSet::of(make_zonotope(Vector::Zero(n), G));
        const RationalSet after = RationalSet::of(make_zonotope(Vector::Zero(n), H));
        CHECK(before.support(d).value <= after.support(d).value);
      }
      // a parallelotope is its own reduction but for rounding: the proof costs no width
      if (k % 4 == 0) {
        const Matrix square = G.leftCols(n);
        Matrix doubled(n, 2 * n);
        doubled << square, square;
        const Matrix same = cordon::sets::outward::reduce_generators(doubled, n, method);
        if (method == GeneratorReduction::yang_scott) {
          CHECK(same.cwiseAbs().sum() <= doubled.cwiseAbs().sum() * (1 + 1e-9));
        }
      }
    }
  }
}
