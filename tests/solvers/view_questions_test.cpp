// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/view_questions.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/exact_questions.hpp"
#include "cordon/solvers/polytope.hpp"
#include "cordon/solvers/set_questions.hpp"

using namespace cordon;

namespace {

using Kind = Certificate::Kind;

View cut(LineForm form, const Matrix& H, const Vector& h) { return {std::move(form), {H, h}}; }

LineForm square() { return make_box({Vector{{-1.0, -1.0}}, Vector{{1.0, 1.0}}}); }

/// {x ≥ 0, y ≥ 0, x + y ≤ 1}, by inequalities alone.
View triangle() {
  return cut(make_space(2), Matrix{{-1.0, 0.0}, {0.0, -1.0}, {1.0, 1.0}}, Vector{{0.0, 0.0, 1.0}});
}

double quarter() { return *rc::gen::inRange(-8, 9) / 4.0; }

Matrix quarters(Index rows, Index cols) {
  Matrix A(rows, cols);
  for (double& a : A.reshaped()) a = quarter();
  return A;
}

Polytope polytope_of(const View& X) {
  return Polytope::from(X.form).intersection(Polytope::from_inequalities(X.rows.H, X.rows.h));
}

}  // namespace

TEST_CASE("an inequality bounds the support value, by a proof that can be spoiled") {
  const View X = cut(square(), Matrix{{1.0, 1.0}}, Vector{{1.0}});
  Certificate why;
  CHECK(support(X, Vector{{1.0, 1.0}}, &why) == 1);
  CHECK(why.kind == Kind::rows);
  CHECK(proves_support(X, Vector{{1.0, 1.0}}, 1, why));
  CHECK_FALSE(proves_support(X, Vector{{1.0, 1.0}}, 0.999, why));
  Certificate spoiled = why;
  spoiled.data.tail(1) *= -1;
  CHECK_FALSE(proves_support(X, Vector{{1.0, 1.0}}, 1, spoiled));
  CHECK(support(X, Vector{{1.0, 0.0}}, &why) == 1);
  CHECK(support(X, Vector{{2.0, 1.0}}, &why) == 2);
  CHECK(proves_support(X, Vector{{2.0, 1.0}}, 2, why));
}

TEST_CASE("a polyhedron that no exchange form holds answers by its inequalities") {
  const View half = cut(make_space(2), Matrix{{1.0, 0.0}}, Vector{{3.0}});
  CHECK(support(half, Vector{{2.0, 0.0}}) == 6);
  CHECK(support(half, Vector{{-1.0, 0.0}}) == infinity);
  CHECK(support(half, Vector{{1.0, 1.0}}) == infinity);
  CHECK(is_empty(half) == Answer::no);
  CHECK(contains(half, Vector{{3.0, 1e9}}) == Answer::yes);
  Certificate why;
  CHECK(contains(half, Vector{{3.5, 0.0}}, &why) == Answer::no);
  CHECK(proves_excludes(half, Vector{{3.5, 0.0}}, why));
  CHECK_FALSE(proves_excludes(half, Vector{{2.5, 0.0}}, why));
  CHECK(folded(half).claim == Tightness::outer);
  CHECK(is_bounded(folded(half).form) != Answer::yes);
}

TEST_CASE("contradictory inequalities are empty, by a proof") {
  const View X = cut(make_space(1), Matrix{{1.0}, {-1.0}}, Vector{{1.0, -2.0}});
  Certificate why;
  REQUIRE(is_empty(X, &why) == Answer::yes);
  CHECK(why.kind == Kind::rows);
  CHECK(proves_empty(X, why));
  CHECK(support(X, Vector{{1.0}}) == -infinity);
  View apart = X;
  apart.rows.h[1] = -1;  // x = 1 is left
  CHECK(is_empty(apart) != Answer::yes);
  CHECK_FALSE(proves_empty(apart, why));
}

TEST_CASE("two triangles that touch or not") {
  View right = triangle();
  right.form.c[0] = 0;  // x ≥ 1.25 in place of x ≥ 0
  right.rows.h[0] = -1.25;
  right.rows.h[2] = 3;
  Certificate why;
  CHECK(is_disjoint(triangle(), right, &why) == Answer::yes);
  right.rows.h[0] = -0.5;
  CHECK(is_disjoint(triangle(), right) == Answer::no);
}

TEST_CASE("folded inequalities are the same bounded set") {
  const Folded T = folded(triangle());
  CHECK(T.claim == Tightness::exact);
  CHECK(Polytope::from(T.form) == polytope_of(triangle()));
  const Box hull = interval_hull(T.form);
  CHECK(hull.lower == Vector{{0.0, 0.0}});
  CHECK(hull.upper == Vector{{1.0, 1.0}});
}

TEST_CASE("a maximiser reaches the support value") {
  const LineForm X = make_zonotope(Vector{{1.0, 2.0}}, Matrix{{1.0, 0.5}, {0.0, 2.0}});
  const Vector d{{1.0, -1.0}};
  const Vector x = maximizer(X, d);
  REQUIRE(x.size() == 2);
  CHECK(d.dot(x) == doctest::Approx(support(X, d)));
  CHECK(maximizer(make_space(2), d).size() == 0);
  CHECK(maximizer(make_empty(2), d).size() == 0);
}

TEST_CASE("views of wrong shapes and numbers are refused") {
  View X = triangle();
  X.rows.h.conservativeResize(2);
  CHECK_THROWS_AS(support(X, Vector{{1.0, 0.0}}), Error);
  X = triangle();
  X.rows.H(0, 0) = infinity;
  CHECK_THROWS_AS(contains(X, Vector{{1.0, 0.0}}), Error);
  CHECK_THROWS_AS(support(triangle(), Vector{{1.0}}), Error);
}

TEST_CASE("random views agree with exact polytopes") {
  CHECK(rc::check("supports, emptiness, points and folded sets", [] {
    const Index n = *rc::gen::inRange<Index>(1, 4), r = *rc::gen::inRange<Index>(1, 5),
                g = *rc::gen::inRange<Index>(1, 5);
    const bool lines = *rc::gen::inRange(0, 4) == 0;
    const View X = cut(lines ? make_space(n) : make_zonotope(quarters(n, 1), quarters(n, g)),
                       quarters(r, n), quarters(r, 1));
    const Polytope P = polytope_of(X);
    Certificate why;
    const Answer empty = is_empty(X, &why);
    RC_ASSERT(empty != (P.is_empty() ? Answer::no : Answer::yes));
    if (empty == Answer::yes) RC_ASSERT(proves_empty(X, why));
    if (empty == Answer::no) RC_ASSERT(proves_not_empty(X, why));
    const Vector d = quarters(n, 1), x = quarters(n, 1);
    const double h = support(X, d, &why), exact = P.support(d).upper;
    RC_ASSERT(h >= P.support(d).lower);
    RC_ASSERT(proves_support(X, d, h, why) || h == infinity);
    if (std::isfinite(exact) && empty == Answer::no) RC_ASSERT(h <= exact + 1e-9);
    RC_ASSERT(contains(X, x) != (P.contains(x) ? Answer::no : Answer::yes));
    const Folded F = folded(X);
    if (!P.is_empty()) RC_ASSERT(Polytope::from(F.form).contains(P));
    if (F.claim == Tightness::exact && !P.is_empty() && P.is_bounded())
      RC_ASSERT(support(F.form, d) <= exact + 1e-9);
  }));
}
