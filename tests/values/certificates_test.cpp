// SPDX-License-Identifier: GPL-3.0-or-later
// Proofs that come with answers hold when they are checked in rational arithmetic, and only for
// what they were given with.
#include <doctest/doctest.h>

#include "cordon/solvers/certificate.hpp"
#include "cordon/solvers/polytope.hpp"
#include "values/known_sets.hpp"

using namespace values_test;

namespace {

LineForm form_of(const ConvexSet& X) {
  REQUIRE(X.view().is_exact_form());
  return X.view().form;
}

}  // namespace

TEST_CASE("of points") {
  for (const ConvexSet& X : {hexagon(), triangle(), hexagon().as("line_zonotope"), unit_box(2)}) {
    CAPTURE(to_string(X));
    const Vector inside{{-0.5, 0.25}}, outside{{-5, 4}};
    Certificate why;
    REQUIRE(X.contains(inside, &why) == Answer::yes);
    CHECK(proves_contains(form_of(X), inside, why));
    CHECK_FALSE(proves_contains(form_of(X), outside, why));
    REQUIRE(X.contains(outside, &why) == Answer::no);
    CHECK(proves_excludes(form_of(X), outside, why));
    CHECK_FALSE(proves_excludes(form_of(X), inside, why));
  }
}

TEST_CASE("of emptiness") {
  const ConvexSet empty = triangle() & (triangle() + Vector{{1.5, 1.5}});
  Certificate why;
  REQUIRE(empty.is_empty(&why) == Answer::yes);
  CHECK(proves_empty(form_of(empty), why));
  REQUIRE(triangle().is_empty(&why) == Answer::no);
  CHECK(proves_not_empty(form_of(triangle()), why));
  CHECK_FALSE(proves_empty(form_of(triangle()), why));
  REQUIRE(ConvexSet::empty(2, "zonotope").is_empty(&why) == Answer::yes);
  CHECK(why.kind != Certificate::Kind::none);
}

TEST_CASE("of pairs") {
  const ConvexSet X = triangle(), apart = triangle() + Vector{{1.5, 1.5}};
  Certificate why;
  REQUIRE(X.is_disjoint(apart, &why) == Answer::yes);
  CHECK(proves_disjoint(form_of(X), form_of(apart), why));
  CHECK_FALSE(proves_disjoint(form_of(X), form_of(hexagon()), why));
  REQUIRE(X.is_disjoint(hexagon(), &why) == Answer::no);
  CHECK(proves_meet(form_of(X), form_of(hexagon()), why));
  REQUIRE((1.01 * unit_box(2)).is_subset(X, &why) == Answer::no);
  REQUIRE(why.kind == Certificate::Kind::direction);
  const Interval beyond = Polytope::from(form_of(1.01 * unit_box(2))).support(why.data);
  const Interval bound = Polytope::from(form_of(X)).support(why.data);
  CHECK(beyond.lower > bound.upper);
}

TEST_CASE("of boxes, which answer by themselves") {
  const ConvexSet X = unit_box(2), apart = unit_box(2) + Vector{{2.5, 0}};
  Certificate why;
  REQUIRE(X.is_disjoint(apart, &why) == Answer::yes);
  CHECK(proves_disjoint(form_of(X), form_of(apart), why));
  REQUIRE(X.is_disjoint(X + Vector{{1, 1}}, &why) == Answer::no);
  CHECK(proves_meet(form_of(X), form_of(X + Vector{{1, 1}}), why));
}

TEST_CASE("without an answer, and without a proof that can be written down, none is left over") {
  Certificate why;
  REQUIRE(hexagon().contains(Vector{{1, 2}}, &why) == Answer::yes);
  REQUIRE(why.kind != Certificate::Kind::none);
  const ConvexSet E = unit_box(2).as("ellipsoid") + unit_box(2);
  REQUIRE(E.contains(Vector{{0, 0}}, &why) == Answer::yes);
  CHECK(why.kind == Certificate::Kind::none);
  REQUIRE(hexagon().contains(Vector{{1, 2}}, &why) == Answer::yes);
  REQUIRE(triangle().is_subset(unit_box(2), &why) == Answer::unknown);
  CHECK(why.kind == Certificate::Kind::none);
}

TEST_CASE("of bounds") {
  for (const ConvexSet& X : {hexagon(), triangle(), segment(), strip(), unit_box(2)}) {
    CAPTURE(to_string(X));
    const Vector d{{1, 1}};
    Certificate why;
    const double h = X.support(d, nullptr, &why);
    CHECK(h < infinity);
    CHECK(proves_support(form_of(X), d, h, why));
    CHECK_FALSE(proves_support(form_of(X), d, h - 1e-6, why));
    std::vector<Certificate> proofs;
    const Box hull = X.hull(&proofs);
    REQUIRE(proofs.size() == 4);
    for (Index i = 0; i < 2; ++i) {
      const Vector e = Vector::Unit(2, i);
      CHECK(proves_support(form_of(X), e, hull.upper[i], proofs[static_cast<std::size_t>(2 * i)]));
      CHECK(proves_support(form_of(X), -e, -hull.lower[i],
                           proofs[static_cast<std::size_t>(2 * i + 1)]));
    }
  }
}
