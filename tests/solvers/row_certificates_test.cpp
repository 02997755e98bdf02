// SPDX-License-Identifier: GPL-3.0-or-later
// What certifies proposals for boxed programs, against rational arithmetic: multipliers of the
// rows, and the distance to a solution of the rows.
#include "solvers/row_certificates.hpp"

#include <random>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"
#include "solvers/random_programs.hpp"
#include "solvers/rational.hpp"
#include "solvers/row_gram.hpp"

using namespace cordon;
using namespace solvers_test;

TEST_CASE("multipliers of any kind prove no more than is true") {
  Programs programs(7);
  std::mt19937_64 engine(8);
  for (int k = 0; k < 300; ++k) {
    const Program p = programs.next();
    const Vector y = random_matrix(engine, p.b.size(), 1),
                 error = random_matrix(engine, p.b.size(), 1).cwiseAbs() * 1e-3;
    const RowCertificates certificates(p.A, p.b, error);
    rational::Rational gain = rational::dot(rational::exact(p.b), rational::exact(y)), plain = 0,
                       shifted = 0, doubt = 0;
    for (Index i = 0; i < y.size(); ++i)
      doubt += rational::exact(error[i]) * abs(rational::exact(y[i]));
    for (Index j = 0; j < p.g.size(); ++j) {
      const rational::Rational column =
          rational::dot(rational::exact(p.A.col(j)), rational::exact(y));
      plain += abs(column);
      shifted += abs(rational::exact(p.g[j]) - column);
    }
    const double margin = certificates.farkas_margin(y), upper = certificates.upper_bound(p.g, y);
    const double size = size_of(p, y);
    CHECK(rational::exact(margin) <= gain - plain - doubt);
    CHECK(rational::exact(upper) >= gain + shifted + doubt);
    CHECK(rational::Rational(gain - plain - doubt).get_d() - margin <= 1e-13 * size);
    CHECK(upper - rational::Rational(gain + shifted + doubt).get_d() <= 1e-13 * size);
  }
}

TEST_CASE("a solution of the rows lies as near as the factor says") {
  std::mt19937_64 engine(9);
  for (const auto& [m, g] : {std::pair<Index, Index>{1, 3}, {5, 30}, {20, 21}, {50, 200}}) {
    const Matrix A = random_matrix(engine, m, g);
    const Vector b = A * (.5 * random_matrix(engine, g, 1)), error = Vector::Zero(m);
    const RowGram gram(A, b, error);
    REQUIRE(gram.is_regular());
    const RowGram::Point point = gram.least_squares();
    CHECK((A.transpose() * point.y - point.xi).lpNorm<Eigen::Infinity>() < 1e-9);
    CHECK(gram.distance(point.xi) < 1e-5);
    // moved off the rows, the nearest solution is the orthogonal one: no claim may be smaller than
    // its distance
    const Vector moved = point.xi + 1e-3 * random_matrix(engine, g, 1);
    const Vector back = A.transpose() * *linalg::solve_spd(A * A.transpose(), b - A * moved);
    CHECK(gram.distance(moved) >= back.lpNorm<Eigen::Infinity>());
    CHECK(RowGram(A, b, Vector::Constant(m, 1e-3)).distance(point.xi) >
          1e-3 / A.rowwise().norm().maxCoeff());
  }
  CHECK_FALSE(RowGram(Matrix{{1, 2}, {2, 4}}, Vector{{1, 2}}, Vector::Zero(2)).is_regular());
  CHECK_FALSE(RowGram(Matrix{{0, 0}}, Vector{{1}}, Vector::Zero(1)).is_regular());
  CHECK_FALSE(RowGram(Matrix{{0, 0}}, Vector{{0}}, Vector{{1e-9}}).is_regular());
  const RowGram idle(Matrix{{0, 0}}, Vector{{0}}, Vector::Zero(1));
  REQUIRE(idle.is_regular());
  CHECK(idle.least_squares().xi == Vector::Zero(2));
  CHECK(idle.distance(Vector{{.5, .5}}) == 0);
}
