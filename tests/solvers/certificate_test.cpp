// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/certificate.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/set_questions.hpp"

using namespace cordon;

namespace {

using Kind = Certificate::Kind;

LineForm with_rows(LineForm X, const Matrix& S, const Matrix& A, const Vector& b) {
  X.S = S;
  X.A = A;
  X.b = b;
  return X;
}

double small_number() { return *rc::gen::inRange(-8, 9) / 4.0; }

Matrix small_matrix(Index rows, Index cols) {
  Matrix A(rows, cols);
  for (double& a : A.reshaped()) a = *rc::gen::inRange(0, 3) == 0 ? 0.0 : small_number();
  return A;
}

LineForm small_set(Index n) {
  const Index l = *rc::gen::inRange<Index>(0, 3), g = *rc::gen::inRange<Index>(0, 6),
              m = *rc::gen::inRange<Index>(0, 4);
  return {small_matrix(n, l), small_matrix(n, g), small_matrix(n, 1),
          small_matrix(m, l), small_matrix(m, g), small_matrix(m, 1)};
}

}  // namespace

TEST_CASE("a proof of emptiness holds, and a spoiled one does not") {
  const LineForm X = with_rows(make_zonotope(Vector{{0.0}}, Matrix{{1.0, 1.0}}), Matrix(1, 0),
                               Matrix{{1.0, 1.0}}, Vector{{2.5}});
  Certificate why;
  REQUIRE(is_empty(X, &why) == Answer::yes);
  CHECK(proves_empty(X, why));
  CHECK_FALSE(proves_not_empty(X, why));
  LineForm reachable = X;
  reachable.b[0] = 2;
  CHECK_FALSE(proves_empty(reachable, why));
  CHECK_FALSE(proves_empty(X, {Kind::farkas, -why.data, why.margin}));
  CHECK_FALSE(proves_empty(X, {Kind::farkas, Vector(2), why.margin}));
  CHECK_FALSE(proves_empty(X, {Kind::point, why.data, why.margin}));
  CHECK_FALSE(proves_empty(X, {Kind::farkas, Vector{{std::nan("")}}, 1}));
}

TEST_CASE("a point near the boundary is moved by all factors where one alone has too little room") {
  const double room = 3e-14;
  const LineForm X =
      with_rows(make_zonotope(Vector{{0.0}}, Matrix{{1.0, 1.0}}), Matrix(1, 0), Matrix{{1.0, 1.0}},
                Vector{{2 - 1.5 * room}});  // beyond (1 - room, 1 - room) by half of it
  CHECK(proves_not_empty(X, {Kind::point, Vector{{1 - room, 1 - room}}, room}));
  CHECK(proves_not_empty(X, {Kind::point, Vector{{1 - 5 * room, 1 - room}}, room}));
  LineForm beyond = X;
  beyond.b[0] = 2 + room;
  CHECK_FALSE(proves_not_empty(beyond, {Kind::point, Vector{{1 - room, 1 - room}}, room}));
}

TEST_CASE("a proof with lines is one about the rows as given") {
  // δ + ξ = 1, 3δ + 3ξ = 4: contradictory after the line is gone, and 3 · 1/3 is no number of the
  // machine
  LineForm X = make_space(1);
  X.G = Matrix{{0.0}};
  X = with_rows(X, Matrix{{1.0}, {3.0}}, Matrix{{1.0}, {3.0}}, Vector{{1.0, 4.0}});
  Certificate why;
  REQUIRE(is_empty(X, &why) == Answer::yes);
  CHECK(proves_empty(X, why));
  X.b[1] = 3;
  REQUIRE(is_empty(X, &why) == Answer::no);
  CHECK(proves_not_empty(X, why));
  REQUIRE(contains(X, Vector{{.5}}, &why) == Answer::yes);
  CHECK(proves_contains(X, Vector{{.5}}, why));
  REQUIRE(contains(X, Vector{{2.5}}, &why) == Answer::no);
  CHECK(proves_excludes(X, Vector{{2.5}}, why));
  CHECK_FALSE(proves_excludes(X, Vector{{.5}}, why));
}

TEST_CASE("dependent rows and sets that touch are decided exactly") {
  const LineForm unit = make_box({Vector{{-1.0, -1.0}}, Vector{{1.0, 1.0}}});
  // the same row three times, once scaled
  LineForm X = with_rows(unit, Matrix(3, 0), Matrix{{1.0, 1.0}, {1.0, 1.0}, {-.5, -.5}},
                         Vector{{1.0, 1.0, -.5}});
  Certificate why;
  CHECK(is_empty(X, &why) == Answer::no);
  CHECK(proves_not_empty(X, why));
  X.b[2] = -.25;
  CHECK(is_empty(X, &why) == Answer::yes);
  CHECK(proves_empty(X, why));
  // x₁ + x₂ = 2 touches the box at (1, 1)
  X = with_rows(unit, Matrix(1, 0), Matrix{{1.0, 1.0}}, Vector{{2.0}});
  CHECK(is_empty(X, &why) == Answer::no);
  CHECK(proves_not_empty(X, why));
  CHECK(contains(X, Vector{{1.0, 1.0}}, &why) == Answer::yes);
  CHECK(proves_contains(X, Vector{{1.0, 1.0}}, why));
  const LineForm beside = make_box({Vector{{1.0, -1.0}}, Vector{{3.0, 1.0}}});
  CHECK(is_disjoint(unit, beside, &why) == Answer::no);
  CHECK(proves_meet(unit, beside, why));
  CHECK(is_disjoint(unit, make_box({Vector{{1.5, -1.0}}, Vector{{3.0, 1.0}}}), &why) ==
        Answer::yes);
  CHECK(proves_disjoint(unit, make_box({Vector{{1.5, -1.0}}, Vector{{3.0, 1.0}}}), why));
  // by the last place beyond each other: within rounding errors of nominal operations, so nothing
  // is said
  CHECK(is_disjoint(unit, make_zonotope(Vector{{2 + 0x1p-51, 0.0}}, Matrix{{1.0}, {0.0}})) ==
        Answer::unknown);
}

TEST_CASE("a certified bound of the support holds exactly, and nothing below the support does") {
  const LineForm X = with_rows(make_box({Vector{{-1.0, -1.0}}, Vector{{1.0, 1.0}}}), Matrix(1, 0),
                               Matrix{{1.0, 3.0}}, Vector{{.7}});
  const Vector d{{1.0, .1}};
  Certificate why;
  const double h = support(X, d, &why);
  CHECK(h == doctest::Approx(1 - .01));
  CHECK(proves_support(X, d, h, why));
  CHECK_FALSE(proves_support(X, d, h - 1e-12, why));
  std::vector<Certificate> proofs;
  const Box hull = interval_hull(X, &proofs);
  REQUIRE(proofs.size() == 4);
  for (Index i = 0; i < 2; ++i) {
    CHECK(proves_support(X, Vector::Unit(2, i), hull.upper[i],
                         proofs[static_cast<std::size_t>(2 * i)]));
    CHECK(proves_support(X, -Vector::Unit(2, i), -hull.lower[i],
                         proofs[static_cast<std::size_t>(2 * i + 1)]));
    CHECK_FALSE(proves_support(X, Vector::Unit(2, i), hull.upper[i] - 1e-6,
                               proofs[static_cast<std::size_t>(2 * i)]));
  }
}

TEST_CASE("a bound through lines is proven for large sets too") {
  const Index n = 3, l = 3, g = 150, m = 50;
  LineForm X{Matrix(n, l), Matrix(n, g), Vector::Zero(n),
             Matrix(m, l), Matrix(m, g), Vector::Zero(m)};
  double value = 0;
  for (Matrix* block : {&X.M, &X.G, &X.S, &X.A}) {
    for (double& entry : block->reshaped()) {
      value += 1;
      entry = std::sin(value * value);
    }
  }
  const Vector d{{1.0, -.3, .7}};
  Certificate why;
  const double h = support(X, d, &why);
  REQUIRE(h < infinity);
  CHECK(proven_support(X, d, why.data).value_or(infinity) ==
        h);  // what the multipliers prove, not what was computed
}

TEST_CASE("lineality is a matter of ranks") {
  CHECK(has_lineality(make_space(2)));
  CHECK_FALSE(has_lineality(make_point(Vector{{1.0}})));
  LineForm X = make_space(2);
  X = with_rows(X, Matrix{{1.0, 1.0}}, Matrix(1, 0), Vector{{1.0}});
  CHECK(has_lineality(X));
  X = with_rows(X, Matrix{{1.0, 1.0}, {1.0, 1 + 0x1p-52}}, Matrix(2, 0), Vector{{1.0, 1.0}});
  CHECK_FALSE(has_lineality(X));
  CHECK(is_bounded(X) == Answer::yes);
}

TEST_CASE("questions that do not fit are refused") {
  const LineForm X = make_space(2);
  CHECK_THROWS_AS(proves_contains(X, Vector{{1.0}}, {}), Error);
  CHECK_THROWS_AS(proves_support(X, Vector{{1.0, infinity}}, 1, {}), Error);
  CHECK_THROWS_AS(proves_disjoint(X, make_space(3), {}), Error);
}

TEST_CASE("every answer comes with a proof that rational arithmetic confirms") {
  CHECK(rc::check("emptiness, containment, disjointness, support", [] {
    const Index n = *rc::gen::inRange<Index>(0, 4);
    const LineForm X = small_set(n), Y = small_set(n);
    const Vector x = small_matrix(n, 1), d = small_matrix(n, 1);
    Certificate why;
    const auto expect = [&](Answer answer, bool yes, bool no) {
      if (answer == Answer::yes) RC_ASSERT(yes);
      if (answer == Answer::no) RC_ASSERT(no);
      if (answer == Answer::unknown) RC_ASSERT(why.kind == Kind::none);
    };
    Answer answer = is_empty(X, &why);
    expect(answer, proves_empty(X, why), proves_not_empty(X, why));
    answer = contains(X, x, &why);
    expect(answer, proves_contains(X, x, why), proves_excludes(X, x, why));
    answer = is_disjoint(X, Y, &why);
    expect(answer, proves_disjoint(X, Y, why), proves_meet(X, Y, why));
    const double h = support(X, d, &why);
    if (X.lines() == 0) RC_ASSERT(proves_support(X, d, h, why));
    if (std::isfinite(h)) RC_ASSERT(proves_support(X, d, h + 1e-12 * (1 + std::abs(h)), why));
  }));
}
