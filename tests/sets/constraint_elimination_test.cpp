// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/sets/constraint_elimination.hpp"

#include <cmath>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/sets/line_zonotope.hpp"
#include "cordon/sets/outward.hpp"
#include "cordon/solvers/set_questions.hpp"

using namespace cordon;
using sets::ConstraintElimination;

namespace {

double number() { return static_cast<double>(*rc::gen::inRange(-1000, 1001)) / 1000; }

Matrix random_matrix(Index rows, Index cols) {
  Matrix A(rows, cols);
  for (Index k = 0; k < A.size(); ++k) A.data()[k] = number();
  return A;
}

/// A set around a known point whose rows are independent, nearly dependent or dependent.
LineForm random_set(Index n, Index g, Index m, Vector& point) {
  LineForm X = make_zonotope(random_matrix(n, 1), random_matrix(n, g));
  X.A = random_matrix(m, g);
  const int kind = *rc::gen::inRange(0, 4);
  if (m > 1 && kind > 0) {
    const double distance = kind == 1 ? 0.0 : std::pow(10.0, -2.0 * *rc::gen::inRange(1, 7));
    X.A.row(1) = X.A.row(0) * number() + distance * X.A.row(1);
  }
  if (m > 2 && kind > 0) X.A.row(2) = X.A.row(0) + 3 * X.A.row(1);
  if (kind == 3) {
    for (Index j = 0; j < g; ++j) X.A.col(j) *= std::pow(10.0, *rc::gen::inRange(-3, 4));
  }
  Vector xi = random_matrix(g, 1);
  if (*rc::gen::inRange(0, 3) == 0) xi = xi.array().sign().matrix();  // a corner of the box
  X.b = X.A * xi;
  X.S.resize(m, 0);
  point = X.c + X.G * xi;
  return X;
}

}  // namespace

TEST_CASE("no way of eliminating constraints loses a point, empties a set or claims too much") {
  CHECK(rc::check("all options", [] {
    const Index n = *rc::gen::inRange<Index>(1, 4), g = *rc::gen::inRange<Index>(2, 9),
                m = *rc::gen::inRange<Index>(1, 5);
    Vector point;
    const LineForm X = random_set(n, g, m, point);
    const ConstraintElimination options{*rc::gen::arbitrary<bool>(), *rc::gen::arbitrary<bool>()};
    const sets::Reduced reduced =
        sets::eliminate_constraints(X, *rc::gen::inRange<Index>(0, m), options);
    const double scale =
        1 + point.cwiseAbs().maxCoeff() + X.c.cwiseAbs().maxCoeff() + X.G.cwiseAbs().sum();
    RC_ASSERT(is_empty(reduced.set) != Answer::yes);
    RC_ASSERT(contains(reduced.set, point) != Answer::no);
    const Vector d = random_matrix(n, 1);
    RC_ASSERT(support(reduced.set, d) >= d.dot(point) - 1e-8 * scale);
    if (reduced.exact) RC_ASSERT(support(reduced.set, d) <= support(X, d) + 1e-6 * scale);
  }));
}

TEST_CASE("dependent rows of integers are no contradiction") {
  LineForm X = make_zonotope(Vector{{0.0}}, Matrix{{1.0, 1.0, 1.0, 1.0, 1.0, 1.0}});
  X.A = Matrix{{3, 3, 7, -3, 6, 5}, {0, 2, -9, 2, 3, -9}, {9, 3, 48, -15, 9, 42}};
  X.b = Vector{{-15.75, 7.75, -70.5}};
  X.S.resize(3, 0);
  for (const bool rescale : {false, true}) {
    for (const bool gauss_jordan : {false, true}) {
      for (Index rows = 0; rows < 3; ++rows)
        CHECK(is_empty(sets::eliminate_constraints(X, rows, {rescale, gauss_jordan}).set) !=
              Answer::yes);
    }
  }
}

TEST_CASE("an empty set stays empty, an infeasible row is kept") {
  CHECK(is_empty(sets::eliminate_constraints(make_empty(2), 0).set) == Answer::yes);
  LineForm X = make_zonotope(Vector{{0.0}}, Matrix{{1.0, 0.0}});
  X.A = Matrix{{1.0, 1.0}};
  X.b = Vector{{5.0}};
  X.S.resize(1, 0);
  CHECK(is_empty(sets::reduce(X, 5, 5).set) == Answer::yes);
  // the false row is no dimension that the generators would have to span
  const LineForm stretched{Matrix(1, 0), Matrix{{1, 1, 1}},  Vector{{0}},
                           Matrix(1, 0), Matrix::Zero(1, 3), Vector{{1}}};
  CHECK(is_empty(sets::reduce(stretched, 1, 0).set) == Answer::yes);
  CHECK(is_empty(sets::outward::reduce(stretched, 1, 0).set) == Answer::yes);
  // rows that contradict each other show it when there is no room for either
  const LineForm contradiction{Matrix(1, 0),
                               Matrix{{1, 1, 1, 1}},
                               Vector{{0}},
                               Matrix(2, 0),
                               Matrix{{1, 1, 0, 0}, {1, 1, 0, 0}},
                               Vector{{.1, .9}}};
  CHECK(is_empty(sets::reduce(contradiction, 1, 5).set) == Answer::yes);
  CHECK(is_empty(sets::outward::reduce(contradiction, 1, 5).set) == Answer::yes);
}

TEST_CASE("a factor is forgotten without loss only if one row bounds it by itself") {
  // ξ₁ = ξ₂/2: |ξ₁| ≤ 1 follows
  LineForm X = make_zonotope(Vector{{0.0}}, Matrix{{1.0, 0.0}});
  X.A = Matrix{{1.0, -.5}};
  X.b = Vector{{0.0}};
  X.S.resize(1, 0);
  const sets::Reduced reduced = sets::eliminate_constraints(X, 0);
  CHECK(reduced.exact);
  CHECK(support(reduced.set, Vector{{1.0}}) == doctest::Approx(.5));
  // ξ₁ = 2 ξ₂ - 1/2 ξ₃ - 1: some bound must be lost
  X.G = Matrix{{1.0, 1.0, 1.0}};
  X.A = Matrix{{1.0, -2.0, .5}};
  X.b = Vector{{-1.0}};
  CHECK_FALSE(sets::eliminate_constraints(X, 0).exact);
}

TEST_CASE("a set is not called exact where only rounding leaves it a line") {
  LineForm X{Matrix::Identity(2, 2), Matrix::Zero(2, 1), Vector::Zero(2),
             Matrix(2, 2),           Matrix(2, 1),       Vector::Zero(2)};
  X.S << 1.5500000000000002e-06, 0.18, 1550,
      179999999.99999997;  // proportional but for the last digits
  X.A << 0, 1000;
  const sets::Reduced bounded = sets::reduce(X, 10, 10, {});
  CHECK(bounded.set.lines() == 1);
  CHECK_FALSE(bounded.exact);

  X.S.row(1) = 0x1p40 * X.S.row(0);
  const sets::Reduced unbounded = sets::reduce(X, 10, 10, {});
  CHECK(unbounded.set.lines() == 1);
  CHECK(unbounded.exact);
}
