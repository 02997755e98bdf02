// SPDX-License-Identifier: GPL-3.0-or-later
// Operators and their named relatives: numbers that are known, mixed operands, claims.
#include <doctest/doctest.h>

#include "values/known_sets.hpp"

using namespace values_test;

TEST_CASE("maps, translations and multiples") {
  const Matrix A{{0, 1}, {2, 0}, {1, 1}};
  const ConvexSet Y = A * hexagon();
  CHECK(Y.dim() == 3);
  CHECK(is(Y.hull(), Vector{{0, -2, -1}}, Vector{{4, 6, 7}}));
  CHECK(is((2 * hexagon()).hull(), Vector{{-2, 0}}, Vector{{6, 8}}));
  CHECK(is((0.5 * hexagon()).hull(), Vector{{-0.5, 0}}, Vector{{1.5, 2}}));
  CHECK(is((0 * hexagon()).hull(), Vector{{0, 0}}, Vector{{0, 0}}));
  CHECK(is((-hexagon()).hull(), Vector{{-3, -4}}, Vector{{1, 0}}));
  const Vector t{{10, 20}};
  CHECK(is((hexagon() + t).hull(), Vector{{9, 20}}, Vector{{13, 24}}));
  CHECK(is((t + hexagon()).hull(), Vector{{9, 20}}, Vector{{13, 24}}));
  CHECK(is((hexagon() - t).hull(), Vector{{-11, -20}}, Vector{{-7, -16}}));
  CHECK(
      is(hexagon().affine_map(A, Vector{{1, 1, 1}}).hull(), Vector{{1, -1, 0}}, Vector{{5, 7, 8}}));
}

TEST_CASE("sum, intersection, product, hull of two") {
  const ConvexSet sum = hexagon() + unit_box(2);
  CHECK(is(sum.hull(), Vector{{-2, -1}}, Vector{{4, 5}}));
  CHECK(sum.volume().value == doctest::Approx(12 + 4 + 2 * (4 + 4)).epsilon(1e-9));
  const ConvexSet cut = triangle() & (unit_box(2) + Vector{{1, -1}});
  CHECK(is(cut.hull(), Vector{{0, -1}}, Vector{{1, 0}}));
  CHECK(triangle().intersect(unit_box(2)).hull().upper.isApprox(Vector{{1, 1}}));
  // {x ∈ box : x₁ + x₂ ∈ [1, 5]}
  const ConvexSet corner = unit_box(2)
                               .as("constrained_zonotope")
                               .intersect(Matrix{{1, 1}}, ConvexSet::box(Vector{{1}}, Vector{{5}}));
  CHECK(is(corner.hull(), Vector{{0, 0}}, Vector{{1, 1}}));
  const ConvexSet product = hexagon().product(ConvexSet::box(Vector{{7}}, Vector{{8}}));
  CHECK(is(product.hull(), Vector{{-1, 0, 7}}, Vector{{3, 4, 8}}));
  const ConvexSet both =
      ConvexSet::point(Vector{{0, 0}}, "constrained_zonotope").convex_hull(segment());
  CHECK(both.contains(Vector{{0.25, 0.25}}) == Answer::yes);
  CHECK(both.contains(Vector{{0.75, 0.75}}) == Answer::no);
  CHECK(both.contains(Vector{{-0.01, 0.5}}) == Answer::no);
}

TEST_CASE("measurements, interval matrices, reduction") {
  // y = x₁ + v, |v| ≤ 0.25
  const ConvexSet V = ConvexSet::box(Vector{{-0.25}}, Vector{{0.25}});
  const ConvexSet X = unit_box(2).correct(Matrix{{1, 0}}, Vector{{0.5}}, V);
  CHECK(is(X.hull(), Vector{{0.25, -1}}, Vector{{0.75, 1}}));
  CHECK(triangle().correct(Matrix{{1, 0}}, Vector{{3}}, V).is_empty() == Answer::yes);
  const ConvexSet mapped =
      unit_box(2).interval_map(IntervalMatrix(Matrix::Zero(1, 2), Matrix{{0.5, 1}}));
  CHECK(is(mapped.hull(), Vector{{-1.5}}, Vector{{1.5}}));
  CHECK(mapped.claim() == Tightness::outer);
  const Matrix many = Matrix::Random(2, 30);
  const ConvexSet big = ConvexSet::zonotope(Vector::Zero(2), many), small = big.reduce(8);
  CHECK(small.complexity().generators <= 8);
  CHECK(small.claim() == Tightness::outer);
  CHECK(big.is_subset(small) != Answer::no);  // they touch
  for (Index i = 0; i < 8; ++i) {
    const Vector d{{std::cos(i), std::sin(i)}};
    CHECK(small.support(d) >= big.support(d) - 1e-9);
  }
  CHECK(big.reduce(30).enclosure().set == big.enclosure().set);
  const ConvexSet few = triangle().reduce(Budget::unlimited, 0);
  CHECK(few.complexity().constraints == 0);
  CHECK(few.contains(Vector{{-0.5, 0.25}}) == Answer::yes);
}

TEST_CASE("the left operand says which representation the result has") {
  for (const char* left : representations) {
    for (const char* right : representations) {
      CAPTURE(left);
      CAPTURE(right);
      const ConvexSet X = unit_box(2).as(left), Y = (0.5 * unit_box(2)).as(right);
      CHECK((X + Y).representation() == left);
      CHECK((X & Y).representation() == left);
      CHECK(X.product(Y).representation() == left);
      CHECK(X.convex_hull(Y).representation() == left);
      CHECK((Matrix{{1, 1}} * X).representation() == left);
      CHECK(X.correct(Matrix::Identity(2, 2), Vector::Zero(2), Y).representation() == left);
      CHECK((X + Y).contains(Vector{{1.4, -1.4}}) == Answer::yes);
      CHECK((X & Y).contains(Vector{{0.4, -0.4}}) == Answer::yes);
      CHECK((X & Y).contains(Vector{{2.5, 0}}) == Answer::no);
      CHECK(X.convex_hull(Y).contains(Vector{{0.9, 0.9}}) == Answer::yes);
    }
  }
}

TEST_CASE("claims meet: an enclosure is not exact again by an exact operation") {
  const ConvexSet exact = unit_box(2), outer = hexagon().as("interval");
  REQUIRE(exact.claim() == Tightness::exact);
  REQUIRE(outer.claim() == Tightness::outer);
  CHECK((exact + exact).claim() == Tightness::exact);
  CHECK((exact + outer).claim() == Tightness::outer);
  CHECK((outer + exact).claim() == Tightness::outer);
  CHECK((exact & outer).claim() == Tightness::outer);
  CHECK(exact.product(outer).claim() == Tightness::outer);
  CHECK((2 * outer).claim() == Tightness::outer);
  CHECK((outer + Vector{{1, 1}}).claim() == Tightness::outer);
  CHECK(outer.as("zonotope").claim() == Tightness::outer);
  CHECK((exact + hexagon()).claim() == Tightness::outer);  // converted to an interval
  CHECK((hexagon() + exact).claim() == Tightness::exact);
  CHECK((hexagon().as("line_zonotope") & exact).claim() == Tightness::exact);
}

TEST_CASE("sets without points and without bounds") {
  const ConvexSet none = ConvexSet::empty(2), all = ConvexSet::space(2);
  CHECK((none + unit_box(2)).is_empty() == Answer::yes);
  CHECK((none & all).is_empty() == Answer::yes);
  CHECK(none.convex_hull(hexagon()).is_empty() == Answer::no);
  CHECK((all & hexagon()).is_subset(hexagon()) != Answer::no);
  CHECK(is((all & hexagon()).hull(), Vector{{-1, 0}}, Vector{{3, 4}}));
  CHECK((all + hexagon()).contains(Vector{{1e6, -1e6}}) == Answer::yes);
  CHECK((Matrix{{1, 1}} * strip()).is_bounded() == Answer::yes);
  CHECK(is((Matrix{{1, 1}} * strip()).hull(), Vector{{0.5}}, Vector{{1.5}}));
}
