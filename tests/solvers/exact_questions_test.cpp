// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/exact_questions.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/polytope.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "solvers/constrained.hpp"

using namespace cordon;

namespace {

double number() { return *rc::gen::inRange(-20, 21) / 10.0; }

Matrix matrix(Index rows, Index cols) {
  Matrix A(rows, cols);
  for (double& a : A.reshaped()) a = *rc::gen::inRange(0, 4) == 0 ? 0.0 : number();
  return A;
}

/// Small sets, some of them empty, flat or with dependent rows.
LineForm random_set(Index n, Index largest = 6) {
  const Index l = *rc::gen::inRange<Index>(0, 3), g = *rc::gen::inRange<Index>(0, largest),
              m = *rc::gen::inRange<Index>(0, 4);
  LineForm X{matrix(n, l), matrix(n, g), matrix(n, 1), matrix(m, l), matrix(m, g), matrix(m, 1)};
  if (m > 1 && *rc::gen::inRange(0, 3) == 0) {
    X.S.row(1) = 2 * X.S.row(0), X.A.row(1) = 2 * X.A.row(0);
    if (*rc::gen::arbitrary<bool>()) X.b[1] = 2 * X.b[0];
  }
  return X;
}

}  // namespace

TEST_CASE("small gaps decide exactly") {
  const double above = std::nextafter(1.0, 2.0), below = std::nextafter(1.0, 0.0);
  for (const auto& [b, answer] : {std::pair{1.0, Answer::no},
                                  {above, Answer::yes},
                                  {below, Answer::no},
                                  {-1.0, Answer::no},
                                  {-above, Answer::yes}}) {
    CHECK(exact::is_empty(constrained(Matrix{{1.0}}, Matrix{{1.0}}, Vector{{b}})) == answer);
  }
  // .1 + .2 > .3 for the doubles
  const LineForm Z = make_zonotope(Vector{{0.1}}, Matrix{{0.2}});
  CHECK(exact::contains(Z, Vector{{0.3}}) == Answer::yes);
  CHECK(exact::contains(Z, Vector{{0.1 + 0.2}}) == Answer::no);
  const Interval h = exact::support(Z, Vector{{1.0}});
  CHECK(h.upper == 0.1 + 0.2);
  CHECK(h.lower == rounding::down(0.1 + 0.2));
  CHECK(exact::support(make_zonotope(Vector{{0.5}}, Matrix{{0.25}}), Vector{{-3.0}}).lower ==
        -0.75);
  CHECK(exact::support(make_zonotope(Vector{{0.5}}, Matrix{{0.25}}), Vector{{-3.0}}).upper ==
        -0.75);
}

TEST_CASE("degenerate sets") {
  CHECK(exact::is_empty(make_empty(2)) == Answer::yes);
  CHECK(exact::is_empty(make_empty(0)) == Answer::yes);
  CHECK(exact::is_empty(make_space(0)) == Answer::no);
  CHECK(exact::is_empty(make_space(3)) == Answer::no);
  CHECK(exact::contains(make_space(0), Vector(0)) == Answer::yes);
  CHECK(exact::contains(make_empty(0), Vector(0)) == Answer::no);
  CHECK(exact::contains(make_point(Vector{{1.0, 2.0}}), Vector{{1.0, 2.0}}) == Answer::yes);
  CHECK(exact::contains(make_point(Vector{{1.0, 2.0}}), Vector{{1.0, std::nextafter(2.0, 3.0)}}) ==
        Answer::no);
  CHECK(exact::support(make_empty(2), Vector{{1.0, 0.0}}).upper == -infinity);
  CHECK(exact::support(make_space(2), Vector{{1.0, 0.0}}).lower == infinity);
  CHECK(exact::support(make_space(2), Vector::Zero(2)).upper == 0);
  // a line whose freedom a row takes away, and an empty set with a line along the direction
  LineForm X = make_space(1);
  X.S = Matrix{{2.0}}, X.A.resize(1, 0), X.b = Vector{{1.0}};
  CHECK(exact::support(X, Vector{{1.0}}).upper == 0.5);
  X.S = Matrix{{0.0}};
  CHECK(exact::support(X, Vector{{1.0}}).upper == -infinity);
}

TEST_CASE("the directions without a bound are exact") {
  const auto lines = [](Matrix M, Matrix S) {
    const Index n = M.rows(), m = S.rows();
    return LineForm{std::move(M), Matrix(n, 0), Vector::Zero(n),
                    std::move(S), Matrix(m, 0), Vector::Zero(m)};
  };
  CHECK(exact::lineality_space(make_zonotope(Vector{{0.0, 0.0}}, Matrix{{1.0}, {0.0}})).cols() ==
        0);
  CHECK(exact::lineality_space(lines(Matrix{{1, 3}, {3, 9}}, Matrix(0, 2))).cols() == 1);
  CHECK(exact::lineality_space(lines(Matrix{{.1, .3}, {.3, .9}}, Matrix(0, 2))).cols() ==
        2);  // by the last digit
  CHECK(exact::lineality_space(lines(Matrix::Identity(2, 2), Matrix{{.1, .3}, {.3, .9}})).cols() ==
        0);
  const Matrix one =
      exact::lineality_space(lines(Matrix::Identity(2, 2), Matrix{{1e-200, -3e-200}}));
  REQUIRE(one.cols() == 1);
  CHECK(one(0, 0) == 3 * one(1, 0));
  CHECK(one.cwiseAbs().maxCoeff() >= .5);
  CHECK(one.cwiseAbs().maxCoeff() < 2);
}

TEST_CASE("what does not fit is refused") {
  const LineForm X = make_space(2);
  CHECK_THROWS_AS(exact::contains(X, Vector::Zero(3)), Error);
  CHECK_THROWS_AS(exact::support(X, Vector::Zero(3)), Error);
  CHECK_THROWS_AS(exact::support(X, Vector{{std::nan(""), 0.0}}), Error);
  CHECK_THROWS_AS(exact::contains(X, Vector{{infinity, 0.0}}), Error);
  LineForm broken = make_zonotope(Vector::Zero(1), Matrix{{infinity}});
  CHECK_THROWS_AS(exact::is_empty(broken), Error);
  const auto refusal = [](Index g, Index m) -> std::string {
    const LineForm big = constrained(Matrix::Ones(1, g), Matrix::Ones(m, g), Vector::Zero(m));
    try {
      exact::is_empty(big);
    } catch (const Error& error) {
      CHECK(error.code() == Errc::unsupported);
      return error.what();
    }
    return "";
  };
  CHECK(refusal(exact::max_columns, 1).empty());
  CHECK(refusal(exact::max_columns + 1, 1).find("2001") != std::string::npos);
  CHECK(refusal(2, exact::max_rows + 1).find("101") != std::string::npos);
  CHECK(refusal(1251, 40).find("1251 lines and generators with 40 constraints") !=
        std::string::npos);
}

TEST_CASE("extreme numbers stay exact") {
  const LineForm X = constrained(Matrix{{1e-300, 1e300}}, Matrix{{1e-300, -1e300}}, Vector{{0.0}});
  const Interval h = exact::support(X, Vector{{1e300}});
  CHECK(h.lower == rounding::down(h.upper));  // 2e-300 · 1e300 for the doubles, which is not 2
  CHECK(h.upper == doctest::Approx(2.0).epsilon(1e-15));
  CHECK(exact::support(make_zonotope(Vector{{1e300}}, Matrix{{1e300}}), Vector{{1e300}}).upper ==
        infinity);
  CHECK(exact::support(make_zonotope(Vector{{1e300}}, Matrix{{1e300}}), Vector{{1e300}}).lower ==
        std::numeric_limits<double>::max());
  CHECK(exact::support(make_point(Vector{{1e-200}}), Vector{{1e-200}}).lower == 0);
  CHECK(exact::support(make_point(Vector{{1e-200}}), Vector{{1e-200}}).upper ==
        std::numeric_limits<double>::denorm_min());
}

TEST_CASE("both exact ways agree: the simplex method and the double description") {
  CHECK(rc::check("random sets", [] {
    const Index n = *rc::gen::inRange<Index>(0, 4);
    const LineForm X = random_set(n);
    const Polytope P = Polytope::from(X);
    RC_ASSERT((exact::is_empty(X) == Answer::yes) == P.is_empty());
    const Vector d = matrix(n, 1), x = matrix(n, 1);
    const Interval a = exact::support(X, d), b = P.support(d);
    RC_ASSERT(a.lower == b.lower);
    RC_ASSERT(a.upper == b.upper);
    RC_ASSERT((exact::contains(X, x) == Answer::yes) == P.contains(x));
    const Polytope::Generators G = P.generators();
    for (Index j = 0; j < G.vertices.cols(); ++j) {
      const Vector v = G.vertices.col(j);
      RC_ASSERT((exact::contains(X, v) == Answer::yes) == P.contains(v));
    }
  }));
}

TEST_CASE("the fast questions never contradict the exact ones") {
  CHECK(rc::check("random sets", [] {
    const Index n = *rc::gen::inRange<Index>(0, 5);
    const LineForm X = random_set(n, 20);
    const Vector d = matrix(n, 1), x = matrix(n, 1);
    const Answer empty = is_empty(X), inside = contains(X, x);
    if (empty != Answer::unknown) RC_ASSERT(empty == exact::is_empty(X));
    if (inside != Answer::unknown) RC_ASSERT(inside == exact::contains(X, x));
    const Interval h = exact::support(X, d);
    RC_ASSERT(lower_support(X, d) <= h.upper);
    // lines are eliminated nominally: the bound holds up to rounding errors there
    if (X.lines() == 0) RC_ASSERT(support(X, d) >= h.lower);
  }));
}

TEST_CASE("linear programs over boxes of non-negative numbers") {
  const auto maximum = [](const Vector& c, const Matrix& K, const Vector& r,
                          const std::vector<int>& bits) { return exact::maximum(c, K, r, bits); };
  const double third = 1.0 / 3;
  const Interval one = maximum(Vector{{1, 0}}, Matrix{{3, 1}}, Vector{{1}}, {0, 0});  // 3x + y = 1
  CHECK(one.lower <= third);
  CHECK(one.upper >= third);
  CHECK(one.upper == std::nextafter(one.lower, 1));
  CHECK(maximum(Vector{{1, 1}}, Matrix(0, 2), Vector(), {3, -1}).upper == 8.5);
  CHECK(maximum(Vector{{1, 0}}, Matrix{{1, -1}}, Vector{{2}}, {0, 0}).upper ==
        -infinity);  // x = 2 + y > 1
  CHECK(maximum(Vector{{1}}, Matrix{{1}, {.1}}, Vector{{.5, .05}}, {0}).lower == .5);
  CHECK(maximum(Vector{{1}}, Matrix{{3}, {.3}}, Vector{{1, .1}}, {0}).upper ==
        -infinity);  // 3 · .1 ≠ .3, for the doubles
  CHECK_THROWS_AS(maximum(Vector{{1}}, Matrix{{1e-320}}, Vector{{1}}, {-20}), Error);
  CHECK_THROWS_AS(maximum(Vector{{1}}, Matrix{{1}}, Vector{{1}}, {0, 0}), Error);
  CHECK_THROWS_AS(maximum(Vector{{infinity}}, Matrix{{1}}, Vector{{1}}, {0}), Error);
}
