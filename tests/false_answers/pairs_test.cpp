// SPDX-License-Identifier: GPL-3.0-or-later
// docs/false_answers.md: disjoint sets that are called intersecting, inclusions that are missed or
// invented, and the reverse.
#include "asking.hpp"

using namespace cordon;
using namespace cordon::false_answers;

TEST_CASE("A flat zonotope beside a column") {
  const LineForm Z =
      make_zonotope(Vector{{-.9, -.008, -9.8}}, Matrix{{2.13346, .00869669, .00588711, 0},
                                                       {.00011511, -.00493375, 0, .0225347},
                                                       {0, 0, 0, 0}});
  const LineForm X = make_box({Vector{{-.1, -.9, -infinity}}, Vector{{.2, -.6, infinity}}});
  Certificate why;
  CHECK(is_disjoint(Z, X, &why) == Answer::yes);
  CHECK(exact_proof::refuted(exact_proof::rows_of(Z, X), why));
  for (const Represented& r : represented(X)) {  // the representations that hold columns
    CAPTURE(r.name);
    const Enclosure other = r.set->backend().import(Z);
    CHECK(r.set->is_disjoint_from(*other) == Answer::yes);
  }
}

TEST_CASE("An equality that is left out") {
  const LineForm X = make_box(cube(2, 1));
  const LineForm Y = both(make_box(cube(2, 8)), make_strip(Vector{{1, 0}}, 5, 0));
  expect_disjoint(X, Y);
}

TEST_CASE("Two intervals apart") {
  expect_disjoint(make_zonotope(Vector{{0}}, Matrix{{1, 2}}),
                  make_zonotope(Vector{{5}}, Matrix{{1}}));
}

TEST_CASE("Boxes that differ by the last place") {
  for (const char* rounding : {"nominal", "outward"}) {
    for (const auto& backend : backends(rounding)) {
      CAPTURE(backend->info().name);
      CAPTURE(std::string(rounding));
      const auto box = [&](double lower, double upper) {  // without rounding
        return backend->convex_hull(backend->point(Vector{{lower}}),
                                    backend->point(Vector{{upper}}));
      };
      const double above = 1 + 0x1p-52, below = std::nextafter(.1, 0);
      // representations whose hull is the box itself hold it without rounding
      if (box(0, 1)->interval_hull().upper[0] != 1) continue;
      CHECK(box(0, 1)->is_disjoint_from(*box(above, 2)) != Answer::no);
      CHECK(box(0, 1)->is_disjoint_from(*box(1.000001, 2)) == Answer::yes);
      CHECK(box(below, .7)->is_subset_of(*box(.1, .7)) != Answer::yes);
      CHECK(box(.2, .6)->is_subset_of(*box(.1, .7)) != Answer::no);
    }
  }
}

TEST_CASE("Two zonotopes that meet") {
  const LineForm X = make_zonotope(Vector{{.7, 1}}, Matrix{{1, -.2, .5}, {1, .4, .2}});
  const LineForm Y =
      make_zonotope(Vector{{1.5, 1}}, Matrix{{.7, .1, .9, .2}, {-.1, -.1, -.9, -.1}});
  expect_meeting(X, Y);
}

TEST_CASE("A small box at the edge of a polygon") {
  const Vector c{{0.9806984373998077, 0.8502036865893472}},
      r{{0.002214407802010432, 0.0007748971207262034}};
  const LineForm X = make_zonotope(c, Matrix(r.asDiagonal()));
  // an octagon around the circle of radius .15 about (1, 1)
  const LineForm Y = both(both(make_box({Vector{{.85, .85}}, Vector{{1.15, 1.15}}}),
                               make_strip(Vector{{1, 1}}, 2, .2125)),
                          make_strip(Vector{{1, -1}}, 0, .2125));
  expect_meeting(X, Y);
}

TEST_CASE("A square in a segment") {
  const LineForm X = make_box(cube(2, .5)), Y = make_zonotope(Vector{{0, 0}}, Matrix{{1}, {0}});
  Certificate why;
  CHECK(is_subset(X, Y, &why) == Answer::no);
  REQUIRE(why.kind == Certificate::Kind::direction);
  CHECK(exact_proof::zonotope_support(X, why.data) > exact_proof::zonotope_support(Y, why.data));
  for (const Represented& r : represented(X)) {
    CAPTURE(r.name);
    const Answer answer = r.set->is_subset_of(*r.set->backend().import(Y));
    CHECK(answer != Answer::yes);
    if (r.set->has_exact_form()) CHECK(answer == Answer::no);
  }
}

TEST_CASE("Twice a box and a box added to itself") {
  const LineForm B = make_box(cube(3, 1)), sum = minkowski_sum(B, B), twice = make_box(cube(3, 2));
  CHECK(is_subset(sum, twice) != Answer::no);
  CHECK(is_subset(twice, sum) != Answer::no);
  CHECK(is_subset(sum, make_box(cube(3, 2.000001))) == Answer::yes);
  CHECK(is_subset(make_box(cube(3, 1.999999)), sum) == Answer::yes);
  // the facets of both are those of the axes
  for (Index i = 0; i < 3; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      const Vector d = sign * Vector::Unit(3, i);
      CHECK(exact_proof::zonotope_support(sum, d) == 2);
      CHECK(exact_proof::zonotope_support(twice, d) == 2);
    }
  }
}

TEST_CASE("A strip beside a zonotope") {
  const LineForm X = make_box(cube(2, 1)), strip = make_strip(Vector{{1, 0}}, 5, 1);
  Certificate why;
  CHECK(is_disjoint(X, strip, &why) == Answer::yes);
  CHECK(exact_proof::refuted(exact_proof::rows_of(X, strip), why));
  expect_empty(both(X, strip));
  for (const Represented& r : represented(X)) {
    CAPTURE(r.name);
    const SetBackend& backend = r.set->backend();
    const Enclosure noise = backend.box(cube(1, 1));
    const Matrix C{{1, 0}}, T{{1}};
    const Enclosure cut = backend.correct(r.set, {C, Vector{{5}}, {T, noise}});
    CHECK(cut->is_empty() == Answer::yes);
  }
}
