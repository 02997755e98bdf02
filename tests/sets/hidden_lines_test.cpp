// SPDX-License-Identifier: GPL-3.0-or-later
// Lines under a map, and under rows, that leave nothing of a direction but rounding: the exact
// image still holds the direction.
#include <cmath>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/exact_rank.hpp"
#include "cordon/core/line_elimination.hpp"
#include "cordon/sets/line_zonotope.hpp"
#include "cordon/solvers/exact_questions.hpp"

using namespace cordon;

namespace {

LineForm everything(Index n) {
  return {Matrix::Identity(n, n), Matrix(n, 0), Vector::Zero(n),
          Matrix(0, n),           Matrix(0, 0), Vector(0)};
}

sets::Reduced image(const Matrix& A, const LineForm& X) {
  const LineForm interval = make_zonotope(Vector{{0.0}}, Matrix{{0.1}});
  const Matrix T = Matrix::Ones(A.rows(), 1);
  const sets::Summand summand{T, interval};
  return sets::affine_sum(X, A, Vector::Zero(A.rows()), {&summand, 1});
}

Matrix of_rank(Index n, Index rank) {
  Matrix left(n, rank), right(rank, n);
  for (double& a : left.reshaped()) a = *rc::gen::inRange(-20, 21);
  for (double& a : right.reshaped()) a = *rc::gen::inRange(-20, 21);
  return left * right;
}

}  // namespace

TEST_CASE("the image of R² under rows that are dependent but for their last digit is R²") {
  // .1 · .9 and .3 · .3 are different products of doubles
  const sets::Reduced sum = image(Matrix{{.1, .3}, {.3, .9}}, everything(2));
  CHECK(exact::lineality_space(sum.set).cols() == 2);
  CHECK(exact::contains(sum.set, Vector{{3.0, -1.0}}) == Answer::yes);
  CHECK_FALSE(sum.exact);
}

TEST_CASE("and a line where they are dependent") {
  const sets::Reduced sum = image(Matrix{{1, 3}, {3, 9}}, everything(2));
  CHECK(exact::lineality_space(sum.set).cols() == 1);
  CHECK(exact::contains(sum.set, Vector{{3.0, -1.0}}) == Answer::no);
  CHECK(sum.exact);
}

TEST_CASE("images of lines keep their dimension") {
  CHECK(rc::check([] {
    const Index n = *rc::gen::inRange<Index>(2, 6), rank = *rc::gen::inRange<Index>(1, n + 1);
    Matrix A =
        of_rank(n, rank) / *rc::gen::element(1.0, 7.0, 10.0, 1e5);  // some quotients are rounded
    if (*rc::gen::inRange(0, 2) == 0) {
      const double gap = std::pow(10.0, *rc::gen::inRange(-17, -3));
      A(*rc::gen::inRange<Index>(0, n), *rc::gen::inRange<Index>(0, n)) += gap;
    }
    const sets::Reduced sum = image(A, everything(n));
    RC_ASSERT(exact::lineality_space(sum.set).cols() >= rank_modulo_prime(A));
    if (sum.exact) RC_ASSERT(exact::lineality_space(sum.set).cols() == rank_modulo_prime(A));
  }));
}

TEST_CASE("rows that bind lines leave as many as in exact arithmetic") {
  // δ₁ + δ₂ + δ₃ = ξ leaves a plane, of which x = Aδ keeps a second direction by the last digit
  // only
  LineForm X{Matrix{{.1, .3, .2}, {.3, .9, .6}},
             Matrix::Zero(2, 1),
             Vector::Zero(2),
             Matrix{{1.0, 1.0, 1.0}},
             Matrix{{-1.0}},
             Vector{{0.0}}};
  const Index lines = exact::lineality_space(X).cols();
  REQUIRE(lines == 2);
  const LinesSolved solved = solve_for_lines(X);
  CHECK(solved.set.M.cols() == 2);
  CHECK_FALSE(solved.is_whole);
  X.M = Matrix{{1, 3, 2}, {3, 9, 6}};
  CHECK(solve_for_lines(X).set.M.cols() == 1);
  CHECK(solve_for_lines(X).is_whole);
}
