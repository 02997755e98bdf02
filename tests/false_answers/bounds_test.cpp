// SPDX-License-Identifier: GPL-3.0-or-later
// docs/false_answers.md: hulls that lie inside the set, bounds that are lost or depend on an order,
// and unbounded sets that are called bounded.
#include "asking.hpp"
#include "cordon/solvers/exact_questions.hpp"

using namespace cordon;
using namespace cordon::false_answers;

TEST_CASE("A strip is not bounded") {
  const LineForm X = make_strip(Vector{{1, 1}}, 0, 1);
  CHECK(is_bounded(X) == Answer::no);
  const Matrix line = exact::lineality_space(X);
  REQUIRE(line.cols() == 1);
  CHECK(line.col(0).norm() > 0);
  CHECK(mpq_class(line(0, 0)) + mpq_class(line(1, 0)) == 0);  // along the strip, exactly
  expect_inside(X, Vector{{0, 0}});
  for (const Represented& r : represented(X)) {
    CAPTURE(r.name);
    CHECK(r.set->is_bounded() == Answer::no);
    CHECK(r.set->support(Vector{{1, 0}}) == infinity);
  }
}

TEST_CASE("A polygon with a ray") {
  const Matrix H{{0.49999999999999994, 0.8660254037844387},
                 {0.8660254037844387, -0.49999999999999994},
                 {0, -1},
                 {1, 0},
                 {0, 1},
                 {-1, 0}};
  const LineForm X =
      half_spaces(H, Vector{{1.3660253171818983, 0.36602545378443874, 1, 1, 1, 1}}, 16);
  CHECK(is_bounded(X) == Answer::yes);
  expect_inside(X, Vector{{0, 0}});
  std::vector<Certificate> why;
  const Box hull = interval_hull(X, &why);
  for (Index i = 0; i < 2; ++i) {
    const Vector e = Vector::Unit(2, i);
    const std::size_t k = 2 * exact_proof::size_of(i);
    CHECK(hull.upper[i] <= 1 + 1e-12);
    CHECK(hull.lower[i] >= -1 - 1e-12);
    CHECK(exact_proof::proves_support(X, e, hull.upper[i], why[k]));
    CHECK(exact_proof::proves_support(X, -e, -hull.lower[i], why[k + 1]));
  }
}

TEST_CASE("A segment with a ray") {
  const LineForm X = make_zonotope(Vector{{0, 0}}, Matrix{{-.00008}, {.00933}});
  CHECK(is_bounded(X) == Answer::yes);
  expect_hull(X, {Vector{{-.00008, -.00933}}, Vector{{.00008, .00933}}});
  expect_outside(X, Vector{{-.00016, .01866}});
}

TEST_CASE("A least value outside the box") {
  expect_hull(both(segment(-1, 1), segment(-3, 0)), {Vector{{-1}}, Vector{{0}}});
}

TEST_CASE("The box of an unbounded set") {
  const LineForm X = make_box({Vector{{-1, -infinity}}, Vector{{1, infinity}}});
  expect_hull(X, {Vector{{-1, -infinity}}, Vector{{1, infinity}}});
  expect_inside(X, Vector{{.5, 1e9}});
  CHECK(interval_hull(make_empty(2)).is_empty());
}

TEST_CASE("Signs that cancel in a radius") {
  expect_support(make_box(cube(2, 1)), Vector{{-1, 1}}, 2);
}

TEST_CASE("Signs that cancel in an interval matrix") {
  const LineForm X = make_point(Vector{{1, -1}});
  const IntervalMatrix A(Matrix{{0, 0}}, Matrix{{1, 1}});
  for (const Represented& r : represented(X)) {
    CAPTURE(r.name);
    const Enclosure image = r.set->backend().interval_map(r.set, A);
    CHECK(image->contains(Vector{{2}}) != Answer::no);  // (1, -1) X
    CHECK(image->support(Vector{{1}}) >= 2);
    CHECK(image->support(Vector{{-1}}) >= 2);
  }
}

TEST_CASE("A cut far from the origin") {
  const LineForm X = make_box({Vector{{-1000, -5}}, Vector{{-990, 5}}});
  const LineForm cut = intersection(X, Matrix{{1, 0}}, segment(-1005, -995));
  expect_hull(cut, {Vector{{-1000, -5}}, Vector{{-995, 5}}});
  expect_outside(cut, Vector{{-992, 0}});
  for (const Represented& r : represented(X)) {
    CAPTURE(r.name);
    const SetBackend& backend = r.set->backend();
    const Enclosure half =
        backend.intersection(r.set, Matrix{{1, 0}}, backend.import(segment(-1005, -995)));
    const double end = half->support(Vector{{1, 0}});
    CHECK(end >= -995);
    CHECK(end < -990);  // the cut is seen
    if (half.tightness == Tightness::exact) CHECK(end == doctest::Approx(-995).epsilon(1e-12));
    if (end < -992 || r.name.find("ellipsoid") == std::string::npos)  // which go around corners
      CHECK(half->contains(Vector{{-992, 0}}) == Answer::no);
  }
}

TEST_CASE("Two orders of one intersection") {
  const LineForm X = make_box({Vector{{0, 0}}, Vector{{30000, 25}}}),
                 Y = make_box({Vector{{0, 0}}, Vector{{40000, 25}}});
  for (const LineForm& cut : {both(X, Y), both(Y, X)}) {
    std::vector<Certificate> why;
    const Box hull = interval_hull(cut, &why);
    CHECK(hull.upper[0] == doctest::Approx(30000).epsilon(1e-12));
    CHECK(hull.upper[1] == doctest::Approx(25).epsilon(1e-12));
    CHECK(hull.lower.isZero(1e-7));
    for (Index i = 0; i < 2; ++i) {
      const Vector e = Vector::Unit(2, i);
      const std::size_t k = 2 * exact_proof::size_of(i);
      CHECK(exact_proof::proves_support(cut, e, hull.upper[i], why[k]));
      CHECK(exact_proof::proves_support(cut, -e, -hull.lower[i], why[k + 1]));
    }
    expect_inside(cut, Vector{{29999, 24}});
    expect_outside(cut, Vector{{30001, 24}});
  }
}
