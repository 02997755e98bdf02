// SPDX-License-Identifier: GPL-3.0-or-later
// What constructors make: representation, claim, and numbers that are known.
#include <sstream>

#include <doctest/doctest.h>

#include "values/known_sets.hpp"

using namespace values_test;

TEST_CASE("each constructor gives its representation, exactly") {
  const auto check = [](const ConvexSet& X, const std::string& representation, Index n) {
    CAPTURE(to_string(X));
    CHECK(X.representation() == representation);
    CHECK(&X.backend() == &X.enclosure().set->backend());
    CHECK(X.claim() == Tightness::exact);
    CHECK(X.dim() == n);
  };
  check(unit_box(3), "interval", 3);
  check(ConvexSet::point(Vector{{1, 2}}), "zonotope", 2);
  check(ConvexSet::point(Vector{{1, 2}}, "interval"), "interval", 2);
  check(hexagon(), "zonotope", 2);
  check(triangle(), "constrained_zonotope", 2);
  check(strip(), "line_zonotope", 2);
  check(ConvexSet::space(2), "line_zonotope", 2);
  check(ConvexSet::space(2, "interval"), "interval", 2);
  check(ConvexSet::empty(2), "line_zonotope", 2);
  check(ConvexSet::line_zonotope(make_zonotope(Vector::Zero(1), Matrix{{2}})), "line_zonotope", 1);
  for (const char* name : representations) {
    check(ConvexSet::point(Vector{{3}}, name), name, 1);
    check(ConvexSet::empty(3, name), name, 3);
    CHECK(ConvexSet::empty(3, name).is_empty() == Answer::yes);
  }
}

TEST_CASE("hulls and volumes that are known") {
  CHECK(is(unit_box(2).hull(), Vector{{-1, -1}}, Vector{{1, 1}}));
  CHECK(is_above(unit_box(3).volume().value, 8));
  CHECK(unit_box(3).volume().exact);
  CHECK(is(hexagon().hull(), Vector{{-1, 0}}, Vector{{3, 4}}));
  CHECK(hexagon().volume().value == doctest::Approx(12).epsilon(1e-12));
  CHECK(is(triangle().hull(), Vector{{-1, -1}}, Vector{{1, 1}}));
  CHECK(triangle().volume().value >= 2);
  CHECK(triangle().volume().value < 4.001);  // where none is confirmed, that of the hull
  const ConvexSet trapeze =
      unit_box(2)
          .as("constrained_zonotope")
          .intersect(Matrix{{1, 1}}, ConvexSet::box(Vector{{-3}}, Vector{{1}}));
  CHECK(trapeze.volume().value == doctest::Approx(3.5).epsilon(1e-9));
  CHECK(trapeze.volume().exact);
  CHECK(is(segment().hull(), Vector{{0, 0}}, Vector{{1, 1}}));
  CHECK(segment().volume().value < 1.0001);
  CHECK(is(strip().hull(), Vector{{-infinity, -infinity}}, Vector{{infinity, infinity}}));
  CHECK(strip().volume().value == infinity);
  CHECK(is(ConvexSet::space(1).hull(), Vector{{-infinity}}, Vector{{infinity}}));
  CHECK(ConvexSet::empty(2).hull().is_empty());
  CHECK(ConvexSet::empty(2).volume().value == 0);
}

TEST_CASE("boxes keep bounds that are no sums of doubles, and may be free, flat or empty") {
  const ConvexSet X = ConvexSet::box(Vector{{0.1, 2}}, Vector{{0.7, 2}});
  CHECK(is(X.hull(), Vector{{0.1, 2}}, Vector{{0.7, 2}}));
  CHECK(X.hull().contains(Vector{{0.1, 2}}));
  CHECK(X.hull().contains(Vector{{0.7, 2}}));
  CHECK(X.volume().value == 0);
  const ConvexSet half = ConvexSet::box(Vector{{-infinity, 0}}, Vector{{infinity, 1}});
  CHECK(half.is_bounded() == Answer::no);
  CHECK(half.contains(Vector{{1e9, 0.5}}) == Answer::yes);
  CHECK(ConvexSet::box(Vector{{1}}, Vector{{0}}).is_empty() == Answer::yes);
}

TEST_CASE("without dimensions there are the point and nothing") {
  const ConvexSet point = ConvexSet::zonotope(Vector(0), Matrix(0, 0));
  CHECK(point.dim() == 0);
  CHECK(point.is_empty() == Answer::no);
  CHECK(point.contains(Vector(0)) == Answer::yes);
  CHECK(point.volume().value == 1);
  CHECK(point.vertices().cols() == 1);
  CHECK(point.gauge(Vector(0)) == Interval{0, 0});
  CHECK((point + point).contains(Vector(0)) == Answer::yes);
  CHECK((2 * point).dim() == 0);
  CHECK((Matrix(2, 0) * point).contains(Vector::Zero(2)) == Answer::yes);
  const ConvexSet nothing = ConvexSet::empty(0);
  CHECK(nothing.is_empty() == Answer::yes);
  CHECK(nothing.contains(Vector(0)) == Answer::no);
  CHECK(nothing.vertices().cols() == 0);
  CHECK(point.is_disjoint(nothing) == Answer::yes);
  CHECK(ConvexSet::space(0).is_bounded() == Answer::yes);
}

TEST_CASE("of a view: inequalities are kept, and the view's claim") {
  const View half{make_space(2), {Matrix{{1, 1}}, Vector{{1}}}, Tightness::exact};
  const ConvexSet cut = ConvexSet::of(
      {make_box({Vector{{-1, -1}}, Vector{{1, 1}}}), {Matrix{{1, 1}}, Vector{{0}}}, {}},
      cordon::representation("constrained_zonotope"));
  CHECK(cut.claim() == Tightness::exact);
  CHECK(cut.is_subset(triangle()) != Answer::no);
  CHECK(cut.contains(Vector{{0.5, 0.25}}) == Answer::no);
  CHECK(cut.contains(Vector{{-0.5, 0.25}}) == Answer::yes);
  View held{make_zonotope(Vector::Zero(1), Matrix{{1}})};
  held.claim = Tightness::outer;
  CHECK(ConvexSet::of(held, cordon::representation("zonotope")).claim() == Tightness::outer);
  const ConvexSet whole = ConvexSet::of(half, cordon::representation("line_zonotope"));
  CHECK(whole.claim() == Tightness::outer);
  CHECK(whole.contains(Vector{{5, 5}}) == Answer::yes);
}

TEST_CASE("conversion: the set itself where it is of that representation, else an enclosure") {
  const ConvexSet X = hexagon();
  CHECK(X.as("zonotope").enclosure().set == X.enclosure().set);
  const ConvexSet box = X.as("interval");
  CHECK(box.representation() == "interval");
  CHECK(box.claim() == Tightness::outer);
  CHECK(is(box.hull(), Vector{{-1, 0}}, Vector{{3, 4}}));
  CHECK(X.as("constrained_zonotope").claim() == Tightness::exact);
  CHECK(X.as("ellipsoid").claim() == Tightness::exact);  // it keeps what it was given
  const ConvexSet outward = X.as("zonotope", Params().set("rounding", std::string("outward")));
  CHECK(outward.representation() == "zonotope");
  CHECK(outward.backend().info().rounding == Rounding::outward);
  CHECK(X.backend().info().rounding == Rounding::nominal);
  CHECK(X.as(cordon::representation("interval")).hull().upper == box.hull().upper);
}

TEST_CASE("sets in words") {
  CHECK(to_string(hexagon()) == "zonotope in R^2: 3 generators (exact)");
  CHECK(to_string(triangle()) == "constrained_zonotope in R^2: 3 generators, 1 constraint (exact)");
  CHECK(to_string(ConvexSet::point(Vector{{1}})) == "zonotope in R^1 (exact)");
  CHECK(to_string(strip()) == "line_zonotope in R^2: 1 generator, 2 lines, 1 constraint (exact)");
  std::ostringstream out;
  out << hexagon().as("interval");
  CHECK(out.str() == "interval in R^2: 2 generators (outer)");
}
