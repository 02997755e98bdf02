// SPDX-License-Identifier: GPL-3.0-or-later
// Programs of many rows: the interior-point method beside the simplex methods.
#include "solvers/interior_point.hpp"

#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/lp.hpp"
#include "solvers/box_simplex.hpp"

using namespace cordon;

namespace {

/// The states of a stable system of `n` states after `samples` outputs of half as many sensors,
/// nothing reduced.
struct Window {
  Matrix A, G;
  Vector b;

  Window(Index n, Index samples, unsigned seed) {
    std::mt19937 random(seed);
    const auto draw = [&](Index rows, Index cols, double size) {
      Matrix M(rows, cols);
      for (double& x : M.reshaped()) x = size * (static_cast<double>(random()) / 2147483648.0 - 1);
      return M;
    };
    const Index p = n / 2, noises = n + (samples - 1) * n;
    const Matrix F = draw(n, n, 1.5 / std::sqrt(static_cast<double>(n))), C = draw(p, n, 1);
    A = Matrix::Zero(samples * p, noises + samples * p);
    G = Matrix::Zero(n, A.cols());
    b.resize(A.rows());
    G.leftCols(n).setIdentity();
    Vector x = draw(n, 1, 1);
    for (Index k = 0; k < samples; ++k) {
      if (k > 0) {
        G = (F * G).eval();
        G.middleCols(k * n, n) = 0.1 * Matrix::Identity(n, n);
        x = (F * x + draw(n, 1, 0.1)).eval();
      }
      A.middleRows(k * p, p) = C * G;
      A.block(k * p, noises + k * p, p, p) = 0.1 * Matrix::Identity(p, p);
      b.segment(k * p, p) = C * x + draw(p, 1, 0.1);
    }
  }
};

double bound(const Window& window, const Vector& g, const Vector& y) {
  return window.b.dot(y) + (g - window.A.transpose() * y).lpNorm<1>();
}

}  // namespace

TEST_CASE(
    "bounds exceed the optimum of the simplex method by 1e-8 of it at most, and never fall below") {
  int solved = 0;
  Index iterations = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    const Window window(2 + seed % 5, 2 + seed % 7, seed);
    InteriorPoint interior(window.A, window.b);
    BoxSimplex simplex(window.A, window.b);
    const Vector g = window.G.row(0).transpose();
    REQUIRE(simplex.maximize(g, Vector::Zero(g.size())) == BoxSimplex::Status::optimal);
    if (!interior.maximize(g)) continue;
    ++solved;
    const double optimum = simplex.objective(), size = 1 + std::abs(optimum);
    CHECK(bound(window, g, interior.multipliers()) <= optimum + 1e-8 * size);
    CHECK(bound(window, g, interior.multipliers()) >= optimum - 1e-12 * size);
    CHECK(interior.value() <= optimum + 1e-8 * size);
    CHECK((window.A * interior.point() - window.b).lpNorm<Eigen::Infinity>() <= 1e-8);
    CHECK(interior.point().lpNorm<Eigen::Infinity>() <= 1);
    // columns that the simplex method keeps off their bounds are those with the smallest scores
    CHECK(simplex.maximize(g, interior.scores()) == BoxSimplex::Status::optimal);
    iterations += simplex.iterations();
  }
  CHECK(solved >= 38);
  CHECK(iterations <= 4 * solved);  // a corner apart, in the mean
}

TEST_CASE("the last rounds of long windows stay on the rows") {
  for (unsigned seed = 0; seed < 3; ++seed) {
    CAPTURE(seed);
    const Window window(20, 20, seed);
    InteriorPoint interior(window.A, window.b);
    for (Index i = 0; i < 10; ++i) {
      CAPTURE(i);
      CHECK(interior.maximize(window.G.row(i).transpose()));
      CHECK((window.A * interior.point() - window.b).lpNorm<Eigen::Infinity>() <= 1e-9);
    }
  }
}

TEST_CASE("an empty program is not solved") {
  Window window(4, 3, 1);
  window.b *= 100;
  InteriorPoint interior(window.A, window.b);
  CHECK_FALSE(interior.maximize(window.G.row(0).transpose()));
  CHECK_FALSE(InteriorPoint(Matrix{{1, 1}, {1, 1}}, Vector{{0, 1}}).maximize(Vector{{1, 0}}));
}

TEST_CASE("a program of many rows has bounds that another solver's optimum meets") {
  const Window window(12, 20, 3);
  REQUIRE(window.A.rows() == 120);
  BoxedProgram program(window.A, window.b);
  const Vector one = Vector::Ones(window.A.cols());
  LinearProgram other(window.A, window.b, -one, one);
  for (Index i = 0; i < 3; ++i) {
    const Vector g = window.G.row(i).transpose();
    const BoxedProgram::Bound found = program.maximum(g);
    const LinearProgram::Solution expected = other.maximize(g);
    REQUIRE(expected.status == LinearProgram::Status::optimal);
    CHECK(found.solved);
    CHECK(found.upper == doctest::Approx(expected.objective).epsilon(1e-7));
    CHECK(found.upper >= expected.objective - 1e-7);
    REQUIRE(found.xi);
    CHECK(program.lower_support(g, *found.xi) >= found.upper - 1e-6);
  }
}
