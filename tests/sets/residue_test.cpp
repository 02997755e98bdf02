// SPDX-License-Identifier: GPL-3.0-or-later
// Rounding in flat sets: what is known no better than the terms allow is no statement, what is
// known is kept.
#include <doctest/doctest.h>

#include "cordon/sets/line_zonotope.hpp"
#include "cordon/solvers/set_questions.hpp"

using namespace cordon;

namespace {

/// X ∩ {x : C x = z}.
LineForm measured(const LineForm& X, const Matrix& C, const Vector& z) {
  return sets::strip_intersection(X, C, z, Matrix(z.size(), 0), make_point(Vector(0))).set;
}

LineForm interval(double center, double radius) {
  return make_zonotope(Vector{{center}}, Matrix{{radius}});
}

LineForm sum(const LineForm& X, const Matrix& A) {
  const LineForm nothing = make_point(Vector(0));
  const Matrix none(A.rows(), 0);
  const sets::Summand summand{none, nothing};
  return sets::affine_sum(X, A, Vector::Zero(A.rows()), {&summand, 1}).set;
}

}  // namespace

TEST_CASE("a small set far from 0 is measured like any other") {
  const LineForm X = interval(1, 1e-9);
  const Box hull = interval_hull(measured(X, Matrix{{1}}, Vector{{1 + .5e-9}}));
  CHECK(hull.upper[0] - hull.lower[0] < 1e-13);
  CHECK(hull.lower[0] <= 1 + .5e-9);
  CHECK(hull.upper[0] >= 1 + .5e-9);
  CHECK(is_empty(measured(X, Matrix{{1}}, Vector{{1 + 1.01e-9}})) == Answer::yes);
}

TEST_CASE("a point is contradicted beyond 1e-10 of the terms only") {
  const LineForm X = make_point(Vector{{3}});
  for (const double sign : {1.0, -1.0}) {
    CHECK(is_empty(measured(X, Matrix{{1}}, Vector{{3 + sign * 5e-10}})) == Answer::no);
    CHECK(is_empty(measured(X, Matrix{{1}}, Vector{{3 + sign * 7e-10}})) == Answer::yes);
  }
}

TEST_CASE("a contradiction between rows is proven in flat sets too") {
  const LineForm X = make_zonotope(Vector{{1, 1}}, Matrix{{1}, {1}});  // x₁ = x₂
  CHECK(is_empty(measured(X, Matrix{{1, -1}}, Vector{{1e-9}})) == Answer::yes);
  CHECK(is_empty(measured(X, Matrix{{1, -1}}, Vector{{0}})) == Answer::no);
  CHECK(is_empty(measured(X, Matrix::Identity(2, 2), Vector{{1.5, 1.6}})) == Answer::yes);
}

TEST_CASE("rows of rounding errors are left out, others are kept") {
  const LineForm X = make_zonotope(Vector{{1, 1}}, Matrix{{1, 1e-16}, {1, -1e-16}});
  CHECK(measured(X, Matrix{{1, -1}}, Vector{{1e-16}}).constraints() == 0);
  CHECK(measured(X, Matrix{{1, -1}}, Vector{{1e-9}}).constraints() == 1);
  CHECK(measured(X, Matrix{{1, 0}}, Vector{{1}}).constraints() == 1);
  CHECK(measured(make_space(2), Matrix{{1, -1}}, Vector{{0}}).constraints() == 1);
}

TEST_CASE("nearly dependent rows know no more than rounding leaves") {
  // x₁ and x₁ + 1e-6 x₂: errors of 1e-14 in the rows are 1e-8 in x₂
  const LineForm X = make_zonotope(Vector{{1, 0}}, Matrix::Identity(2, 2));
  const Box hull =
      interval_hull(measured(X, Matrix{{1, 0}, {1, 1e-6}}, Vector{{1.5, 1.5 + .5e-6}}));
  CHECK(hull.lower[1] < .5 - 1e-9);
  CHECK(hull.upper[1] > .5 + 1e-9);
  CHECK(hull.upper[1] - hull.lower[1] < 1e-6);
}

TEST_CASE("a sum that cancels is as wide as its errors") {
  const LineForm X = make_point(Vector{{.1 + .2, .3}});
  const Box hull = interval_hull(sum(X, Matrix{{1, -1}}));
  CHECK(hull.lower[0] < 0);
  CHECK(hull.upper[0] > 0);
  CHECK(hull.upper[0] < 1e-13);
  const LineForm diagonal =
      make_zonotope(Vector{{0, 0}}, Matrix{{.1}, {.1}});  // without a centre to tell the size
  CHECK(sum(diagonal, Matrix{{1, -1}}).generators() == 2);
  const LineForm opposite = make_point(Vector{{-.3}});
  const Matrix one{{1}};
  const sets::Summand summand{one, opposite};
  CHECK(sets::affine_sum(make_point(Vector{{0}}), one, Vector{{.1 + .2}}, {&summand, 1})
            .set.generators() == 1);
  CHECK(sum(interval(1, 1), Matrix{{2}}).generators() == 1);
  CHECK(sum(interval(1, 1e-3), Matrix{{2}}).generators() == 1);
  CHECK(sum(interval(1, 1e-6), Matrix{{2}}).generators() == 2);
  CHECK(sum(make_point(Vector{{0}}), Matrix{{2}}).generators() == 0);
}

TEST_CASE("what elimination cancels is as wide as its errors") {
  // x = .3 + ξ, ξ = -.3 in tenths that rounding spoils
  LineForm X = interval(.1 + .2, 1);
  X.S = Matrix(1, 0);
  X.A = Matrix{{3}};
  X.b = Vector{{-.9}};
  const sets::Reduced reduced = sets::eliminate_constraints(X, 0);
  const Box hull = interval_hull(reduced.set);
  CHECK(reduced.exact);
  CHECK(hull.lower[0] < 0);
  CHECK(hull.upper[0] > 0);
  CHECK(hull.upper[0] < 1e-13);
  CHECK(sets::eliminate_constraints(interval(0, 1e-300), 0).set.generators() == 1);
}

TEST_CASE("a row that is missed by less than proofs need leaves the set as it is, and larger") {
  // 1e9 x - (1e9 + 0.16) x = 0.16 + 1e-9 and x in [-1, 1]: nearly x = -1
  const LineForm X = make_zonotope(Vector{{0, 0}}, Matrix{{1}, {1}});
  const Matrix C{{1e9, -(1e9 + .16)}};
  const double reach = std::abs(1e9 - (1e9 + .16));
  const auto cut = [&](double z) {
    return sets::strip_intersection(X, C, Vector{{z}}, Matrix(1, 0), make_point(Vector(0)));
  };
  CHECK_FALSE(cut(reach * 1.0001).exact);
  CHECK(cut(reach * 1.0001).set.constraints() == 0);
  CHECK(cut(reach * .9999).exact);
  CHECK(cut(reach * .9999).set.constraints() == 1);
}
