// SPDX-License-Identifier: GPL-3.0-or-later
// docs/false_answers.md: points inside that are called outside, and the reverse.
#include "asking.hpp"
#include "cordon/solvers/exact_questions.hpp"

using namespace cordon;
using namespace cordon::false_answers;

TEST_CASE("A point of a zonotope with seven generators") {
  const LineForm X = make_zonotope(
      Vector{{0, 0}}, Matrix{{.75, -.05, 1, 1, .25, .05, 0}, {.5, .95, 2.5, 1, -.5, .05, -1.5}});
  expect_inside(X, Vector{{3, 3}});
}

TEST_CASE("A point below a segment") {
  expect_outside(make_zonotope(Vector{{0, 1.5}}, Matrix{{0}, {.5}}), Vector{{0, .5}});
}

TEST_CASE("The vertices of the set itself") {
  const LineForm X =
      make_zonotope(Vector::Zero(3), Matrix{{.75, .5, -.25}, {.5, -1, .125}, {.25, .5, 1}});
  for (int corner = 0; corner < 8; ++corner) {
    CAPTURE(corner);
    const Vector xi{{corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0}};
    expect_inside(X, X.G * xi);  // eighths: without rounding
  }
  CHECK(is_subset(X, X) != Answer::no);
  CHECK(is_subset(X, make_zonotope(X.c, 1.000001 * X.G)) == Answer::yes);
}

TEST_CASE("Beyond a half-space by 4e-17") {
  const Matrix H{
      {-0.09291863543681655, -0.2176689899601838, -0.07453829739226348, 0.048948632014371496}};
  const LineForm X = half_spaces(H, Vector{{0.1911363393469332}}, 1);
  const Vector o{
      {0.07768723948819561, -0.5762273280928935, 0.28897399484750297, 1.9299362784322858}};
  CHECK(exact_proof::dot(exact_proof::exact(H.row(0).transpose()), exact_proof::exact(o)) >
        mpq_class(0.1911363393469332));
  CHECK(contains(X, o) != Answer::yes);
  CHECK(exact::contains(X, o) == Answer::no);
  check_membership(X, o + Vector::Unit(4, 1), Answer::yes);
  expect_outside(X, o + 1e-6 * Vector::Unit(4, 3));
}

TEST_CASE("Outside by half a ten-thousandth") { expect_outside(segment(-1, 1), Vector{{1.00005}}); }

TEST_CASE("Outside by five millionths") { expect_outside(segment(-1, 1), Vector{{1.000005}}); }

TEST_CASE("Outside by half a millionth") {
  expect_outside(make_box(cube(2, 1)), Vector{{1.0000005, 0}});
}

TEST_CASE("The centre of a zonotope") {
  const LineForm X =
      make_zonotope(Vector{{0, 0}}, Matrix{{.8, .1, .6, .3, .9}, {.9, .9, .1, .5, .2}});
  expect_inside(X, Vector{{0, 0}});
}

TEST_CASE("The end of a short interval") {
  const LineForm X = segment(1000, 1000.005);
  expect_inside(X, Vector{{1000}});
  expect_inside(X, Vector{{1000.004}});
  CHECK(contains(X, Vector{{1000.005}}) != Answer::no);
  CHECK(mpq_class(interval_hull(X).upper[0]) >= mpq_class(1000.005));
}

TEST_CASE("The corner of a box and an ellipse inside") {
  const LineForm X = make_box(cube(2, 3));
  const Vector corner{{3, 3}};
  expect_inside(X, corner);
  CHECK(corner.squaredNorm() / 9 > 1);  // outside the circle of radius 3, the largest one inside
}

TEST_CASE("A set that comes one step late") {
  const LineForm X0 = make_box(cube(2, 3)),
                 X1 = affine_map(X0, Matrix{{0, -.5}, {1, 1}}, Vector::Zero(2));
  const Vector x1{{-1.5, 6}};  // of x0 = (3, 3)
  expect_inside(X1, x1);
  expect_outside(X0, x1);
}

TEST_CASE("A triangle cut out of a square") {
  const Matrix H{{-.70613882, -.45589431}, {.70807342, -.45464871}, {0, .76515026}};
  const LineForm X =
      both(make_box(cube(2, 1)), half_spaces(H, Vector{{-.04178256, .45969769, .35614825}}, 16));
  expect_outside(X, Vector{{0, 0}});
  expect_inside(X, Vector{{.35425774, .14104826}});
}

TEST_CASE("Facets of a cone that are missing") {
  const Matrix g{
      {.5, -.5, .47213, -.47213}, {1, 1, .94423, .94423}, {-.4561, -.51431, .48569, .43067}};
  const Vector x{{1, -.1, -1}};
  // the two facets that were found hold for x
  CHECK(61086.46209 * x[0] + 30543.74535 * x[1] + x[2] > 0);
  CHECK(x[0] + 8.327781847 * x[1] - 17.16212286 * x[2] > 0);
  expect_outside(make_zonotope(g.rowwise().sum() / 2, g / 2), x);
}

TEST_CASE("Vertices of a polygon that are missing") {
  const Matrix H{{-0.9292178750038147, -0.36953237652778625},
                 {-0.058287363499403, 0.9982998371124268},
                 {0.0582873672246933, -0.9982998371124268},
                 {-1, 0},
                 {0, 1},
                 {0, -1}};
  const LineForm X = half_spaces(
      H, Vector{{-0.5367662906646729, 0.39611172676086426, -0.17240175604820251, -.45, .45, -.35}},
      16);
  expect_not_empty(X);
  expect_inside(X, Vector{{3, .44}});
  // the three vertices that were found end at x = 3.04, and lie below the line that joins them
  CHECK(.44 > .4230603118 + (.35 - .4230603118) * (3 - .45) / (3.036733264 - .45));
  CHECK(interval_hull(X).upper[0] >= 4.749454);
}
