// SPDX-License-Identifier: GPL-3.0-or-later
// docs/false_answers.md: sets that are called empty and are not, and the reverse.
#include "asking.hpp"
#include "cordon/solvers/exact_questions.hpp"

using namespace cordon;
using namespace cordon::false_answers;

namespace {

/// Answers that no nominal proof reaches: `unknown`, and rational arithmetic decides.
void expect_empty_but_for_rounding(const LineForm& X, const Vector& y) {
  CHECK(is_empty(X) == Answer::unknown);
  CHECK(exact::is_empty(X) == Answer::yes);
  CHECK(exact_proof::refuted(exact_proof::rows_of(X), {Certificate::Kind::farkas, y, 0}));
  for (const Represented& r : represented(X)) {
    CAPTURE(r.name);
    if (r.is_exact()) CHECK(r.set->is_empty() != Answer::no);
  }
}

}  // namespace

TEST_CASE("A gap of one unit in the last place") {
  // 1.5 + 2⁻⁵² ± .5, which a box with these ends could only enclose
  const LineForm X = both(segment(0, 1), make_zonotope(Vector{{1.5 + 0x1p-52}}, Matrix{{.5}}));
  REQUIRE(X.constraints() == 1);
  expect_empty_but_for_rounding(X, Vector{{X.b[0] > 0 ? 1.0 : -1.0}});
  expect_empty(both(segment(0, 1), segment(1.00000009, 2)));
}

TEST_CASE("A segment that is refined away") {
  const LineForm X = make_zonotope(Vector{{-.0432, -11}}, Matrix{{.0056}, {4.67}});
  expect_not_empty(X);
  for (const Represented& r : represented(X)) {
    CAPTURE(r.name);
    const Box hull = r.set->interval_hull();
    for (Index i = 0; i < 2; ++i) {
      const mpq_class c(X.c[i]), g(X.G(i, 0));
      CHECK(mpq_class(hull.upper[i]) >= c + g);
      CHECK(mpq_class(hull.lower[i]) <= c - g);
    }
    const Vector d{{-.999999, .00119914}};
    CHECK(mpq_class(r.set->support(d)) >= exact_proof::zonotope_support(X, d));
  }
}

TEST_CASE("Beyond the end of an interval") {
  expect_empty(both(segment(18, 18.1), segment(21, 22)));
}

TEST_CASE("Cut to one point in two steps") {
  const LineForm X = segment(4, 5), Y = segment(3, 5), Z = segment(5, 6);
  for (const LineForm& cut : {both(both(X, Y), Z), both(X, both(Y, Z))}) {
    expect_not_empty(cut);
    expect_inside(cut, Vector{{5}});
    expect_hull(cut, {Vector{{5}}, Vector{{5}}});
  }
}

TEST_CASE("An empty parallelotope with four vertices") {
  const LineForm X =
      half_spaces(Matrix{{1, 1}, {0, 1}, {-1, -1}, {0, -1}}, Vector{{2.5, 2, -4, -1}}, 16);
  expect_empty(X);
  expect_outside(X, Vector{{2, 2}});
}

TEST_CASE("A half-space beside a square") {
  const LineForm X = both(make_box(cube(2, 1)), make_box({Vector{{3, -9}}, Vector{{5, 9}}}));
  expect_empty(X);
  CHECK(interval_hull(X).is_empty());
}

TEST_CASE("A row of 1e-16") {
  const LineForm X{Matrix(2, 0), Matrix::Identity(2, 2),     Vector::Zero(2),
                   Matrix(2, 0), Matrix{{1, 0}, {0, 1e-16}}, Vector{{0, 5e-17}}};
  expect_not_empty(X);
  expect_inside(X, Vector{{0, .5}});
}

TEST_CASE("Two rows that differ by 1e-11") {
  const LineForm X{Matrix(2, 0), Matrix::Identity(2, 2), Vector::Zero(2),
                   Matrix(2, 0), Matrix::Ones(2, 2),     Vector{{.5, .5 + 1e-11}}};
  expect_empty_but_for_rounding(X, Vector{{-1, 1}});
}

TEST_CASE("Dependent rows and any failure") {
  const LineForm X{
      Matrix(1, 0),      Matrix{{1, 1}}, Vector::Zero(1), Matrix(2, 0), Matrix{{.1, .2}, {.3, .6}},
      Vector{{.05, .15}}};
  expect_not_empty(X);
}

TEST_CASE("Apart by five millionths") { expect_empty(both(segment(-1, 1), segment(1.000005, 3))); }

TEST_CASE("Between 0 and 6e-8") {
  const Matrix H{{1, 1},  {1, -1}, {-1, 1}, {-1, -1}, {1, 0}, {0, 1},
                 {0, -1}, {-1, 0}, {0, 1},  {-1, 0},  {1, 0}};
  const Vector h{{-13.626037500000011, 14.829706875000008, -14.224500059337577, 14.714999990399326,
                  0.5984624999999967, -14.224500000000008, 14.715000000000012,
                  -5.666114613038476e-8, 0, 0, 0}};
  expect_empty(half_spaces(H, h, 32));
  expect_not_empty(half_spaces(H.topRows(8), h.head(8), 32));
}

TEST_CASE("A flat set is a set") {
  const LineForm X = make_zonotope(Vector{{.5, 0}}, Matrix{{.5}, {0}});
  expect_not_empty(X);
  expect_inside(X, Vector{{.25, 0}});
  expect_hull(X, {Vector{{0, 0}}, Vector{{1, 0}}});
  for (const Represented& r : represented(affine_map(X, Matrix{{1, 0}}, Vector{{0}}))) {
    CAPTURE(r.name);
    CHECK(r.set->is_empty() == Answer::no);
    CHECK(r.set->interval_hull().upper[0] >= 1);
  }
}

TEST_CASE("A point in the empty set") {
  for (const Vector& x : {Vector{{0, 0, 0}}, Vector{{-1, 0, 0}}}) expect_outside(make_empty(3), x);
}
