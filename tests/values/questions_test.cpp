// SPDX-License-Identifier: GPL-3.0-or-later
// Questions: answers that are known.
#include <doctest/doctest.h>

#include "values/known_sets.hpp"

using namespace values_test;

TEST_CASE("is it empty, does it hold a point, is it bounded") {
  CHECK(hexagon().is_empty() == Answer::no);
  CHECK(triangle().is_empty() == Answer::no);
  const ConvexSet nothing = ConvexSet::constrained_zonotope(Vector::Zero(1), Matrix::Ones(1, 1),
                                                            Matrix::Ones(1, 1), Vector{{2}});
  CHECK(nothing.is_empty() == Answer::yes);
  CHECK(hexagon().contains(Vector{{2.9, 3.9}}) == Answer::yes);
  CHECK(hexagon().contains(Vector{{3, 4}}) == Answer::yes);
  CHECK(hexagon().contains(Vector{{-0.9, 3.9}}) == Answer::no);  // of its hull only
  CHECK(segment().contains(Vector{{0.25, 0.75}}) == Answer::yes);
  CHECK(segment().contains(Vector{{0.25, 0.5}}) == Answer::no);
  CHECK(strip().contains(Vector{{100, -99}}) == Answer::yes);
  CHECK(strip().contains(Vector{{100, -98}}) == Answer::no);
  CHECK(ConvexSet::space(3).contains(Vector{{1, 2, 3}}) == Answer::yes);
  CHECK(hexagon().is_bounded() == Answer::yes);
  CHECK(strip().is_bounded() == Answer::no);
  CHECK(ConvexSet::space(1).is_bounded() == Answer::no);
  CHECK(ConvexSet::empty(1).is_bounded() == Answer::yes);
}

TEST_CASE("is one within the other, are two apart") {
  CHECK(triangle().is_subset(1.01 * unit_box(2)) == Answer::yes);
  CHECK((1.01 * unit_box(2)).is_subset(triangle()) == Answer::no);
  CHECK(triangle().is_subset(unit_box(2)) != Answer::no);  // they touch
  CHECK(hexagon().is_subset(hexagon() + 0.01 * unit_box(2)) == Answer::yes);
  CHECK(hexagon().is_subset(hexagon() + Vector{{0.01, 0}}) == Answer::no);
  CHECK((0.5 * unit_box(2)).is_subset(unit_box(2)) == Answer::yes);
  CHECK(ConvexSet::empty(2).is_subset(hexagon()) == Answer::yes);
  CHECK(hexagon().is_disjoint(hexagon() + Vector{{-3, 3}}) == Answer::yes);  // hulls meet
  CHECK(hexagon().is_disjoint(hexagon() + Vector{{3, 3}}) == Answer::no);
  CHECK(strip().is_disjoint(unit_box(2)) == Answer::no);
  CHECK(strip().is_disjoint(unit_box(2) + Vector{{2, 2}}) == Answer::yes);
  CHECK(segment().is_disjoint(ConvexSet::point(Vector{{0.5, 0.5}})) == Answer::no);
}

TEST_CASE("support values with the points where they are reached") {
  Vector at;
  CHECK(is_above(hexagon().support(Vector{{1, 0}}, &at), 3));
  CHECK(at[0] == 3);
  CHECK(hexagon().contains(at) == Answer::yes);
  CHECK(is_above(hexagon().support(Vector{{1, -1}}), 1));
  CHECK(is_above(hexagon().support(Vector{{0, 0}}), 0));
  CHECK(triangle().support(Vector{{1, 1}}, &at) == doctest::Approx(0).epsilon(1e-12));
  REQUIRE(at.size() == 2);
  CHECK(at.sum() == doctest::Approx(0).epsilon(1e-9));
  CHECK(strip().support(Vector{{1, 1}}) == doctest::Approx(1.5).epsilon(1e-12));
  CHECK(strip().support(Vector{{1, 0}}, &at) == infinity);
  CHECK(at.size() == 0);
  CHECK(ConvexSet::empty(2).support(Vector{{1, 0}}) == -infinity);
  CHECK(is_above(unit_box(1).support(Vector{{-2}}), 2));
}

TEST_CASE("ellipsoids answer by what they are") {
  // the ellipsoid around the unit box is the disc of radius √2
  const ConvexSet E = unit_box(2).as("ellipsoid") + ConvexSet::point(Vector{{0, 0}});
  CHECK(E.representation() == "ellipsoid");
  CHECK(E.claim() == Tightness::outer);
  CHECK(E.contains(Vector{{1, 1}}) != Answer::no);
  CHECK(E.contains(Vector{{2, 2}}) == Answer::no);
  CHECK(E.support(Vector{{1, 1}}) >= 2);
  CHECK(E.is_disjoint(unit_box(2) + Vector{{5, 5}}) == Answer::yes);
}
