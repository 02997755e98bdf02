// SPDX-License-Identifier: GPL-3.0-or-later
// Polytopes that are known by hand or published, degenerate ones, and what is refused.
#include "cordon/solvers/polytope.hpp"

#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/exact_budget.hpp"
#include "cordon/solvers/exact_questions.hpp"
#include "solvers/polytopes.hpp"

using namespace cordon;
using namespace solvers_test;

namespace {

Polytope cube(Index n) { return Polytope::from_inequalities(stacked(n), Vector::Ones(2 * n)); }

Polytope cross_polytope(Index n) {
  Matrix V(n, 2 * n);
  V << Matrix::Identity(n, n), -Matrix::Identity(n, n);
  return Polytope::from_generators(V);
}

Polytope simplex(Index n) {
  Matrix V(n, n + 1);
  V << Vector::Zero(n), Matrix::Identity(n, n);
  return Polytope::from_generators(V);
}

bool is(Interval range, double value) { return range.lower == value && range.upper == value; }

}  // namespace

TEST_CASE("cubes, simplices and cross polytopes") {
  double factorial = 1;
  for (Index n = 1; n <= 5; ++n) {
    factorial *= static_cast<double>(n);
    const double corners = std::exp2(n);
    CHECK(is(cube(n).volume(), corners));
    CHECK(cube(n).generators().vertices.cols() == corners);
    CHECK(cube(n).inequalities().H.rows() == 2 * n);
    CHECK(cross_polytope(n).inequalities().H.rows() == corners);
    CHECK(cross_polytope(n).generators().vertices.cols() == 2 * n);
    CHECK(simplex(n).inequalities().H.rows() == n + 1);
    const Interval volume = cross_polytope(n).volume();
    CHECK(volume.lower <= corners / factorial);
    CHECK(volume.upper >= corners / factorial);
    CHECK(volume.upper <= rounding::up(volume.lower));
    CHECK(simplex(n).volume().lower == doctest::Approx(1 / factorial).epsilon(1e-15));
    CHECK(cube(n).contains(cross_polytope(n)));
    CHECK(!cross_polytope(n).contains(cube(n)) == (n > 1));
    CHECK(cube(n) == Polytope::from(make_zonotope(Vector::Zero(n), Matrix::Identity(n, n))));
    CHECK(is(cube(n).support(Vector::Ones(n)), static_cast<double>(n)));
  }
}

TEST_CASE("points decide to the last bit") {
  const Polytope P =
      Polytope::from_inequalities(Matrix{{3.0}, {-1.0}}, Vector{{1.0, 0.0}});  // [0, 1/3]
  CHECK(P.contains(Vector{{1.0 / 3}}));  // the double lies below 1/3
  CHECK(!P.contains(Vector{{rounding::up(1.0 / 3)}}));
  CHECK(P.support(Vector{{1.0}}).lower == 1.0 / 3);
  CHECK(P.support(Vector{{1.0}}).upper == rounding::up(1.0 / 3));
  CHECK(P.interval_hull().upper[0] == rounding::up(1.0 / 3));
  CHECK(P.interval_hull().lower[0] == 0);
}

TEST_CASE("redundancy goes, equations are found") {
  const Polytope P =
      Polytope::from_inequalities(Matrix{{1, 0}, {2, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {0, 0}},
                                  Vector{{1.0, 2.0, 1.0, 3.0, -3.0, 9.0, 0.0}});
  const Polytope::Inequalities rows = P.inequalities();
  CHECK(rows.H.rows() == 2);
  CHECK(rows.Q.rows() == 1);
  CHECK(P.generators().vertices.cols() == 2);
  CHECK(is(P.volume(), 0));
  const Polytope V = Polytope::from_generators(Matrix{{0, 2, 1, 1, 2}, {0, 0, 0, 1, 0}});
  CHECK(V.generators().vertices.cols() == 3);
  CHECK(is(V.volume(), 1));
}

TEST_CASE("half-spaces of doubles are told as they are") {
  const Matrix H{{3, 3}, {-0.1, 7}, {0, -3}, {-5, -1e-3}};
  const Vector h{{1.0, 1.0, 0.1, 1.0}};
  const Polytope P = Polytope::from_inequalities(H, h);
  const Polytope::Inequalities rows = P.inequalities();
  CHECK(Polytope::from_inequalities(rows.H, rows.h) == P);
  for (Index i = 0; i < rows.H.rows(); ++i) {
    CHECK(rows.H.row(i).cwiseAbs().maxCoeff() > 0.5);
    CHECK(rows.H.row(i).cwiseAbs().maxCoeff() < 2);
    CHECK(is(P.support(rows.H.row(i).transpose()), rows.h[i]));
  }
  const Polytope flat =
      Polytope::from_inequalities(Matrix(0, 2), Vector(0), Matrix{{3, 0}}, Vector{{1.0}});
  const Polytope::Inequalities line = flat.inequalities();
  CHECK(Polytope::from_inequalities(line.H, line.h, line.Q, line.q) == flat);
}

TEST_CASE("lines, rays and half-spaces") {
  const Polytope half = Polytope::from_inequalities(Matrix{{1.0, 1.0}}, Vector{{1.0}});
  CHECK(!half.is_bounded());
  CHECK(half.support(Vector{{2.0, 2.0}}).upper == 2);
  CHECK(half.support(Vector{{1.0, 0.0}}).lower == infinity);
  CHECK(half.generators().rays.cols() == 1);
  CHECK(half.generators().lines.cols() == 1);
  CHECK(code_of([&] { half.volume(); }) == Errc::unsupported);
  CHECK(code_of([&] { half.to_line_form(); }) == Errc::unsupported);
  CHECK(half.minkowski_sum(Polytope::from_inequalities(-Matrix{{1.0, 1.0}}, Vector{{0.0}})) ==
        Polytope::space(2));
  const Polytope strip = Polytope::from(make_strip(Vector{{1.0, -2.0}}, 0.5, 0.25));
  CHECK(strip == Polytope::from_inequalities(Matrix{{1, -2}, {-1, 2}}, Vector{{0.75, -0.25}}));
  CHECK(Polytope::from_generators(Matrix{{0.0}}, Matrix{{1.0, -1.0}}, Matrix(1, 0)) ==
        Polytope::space(1));
  CHECK(Polytope::space(2).interval_hull().upper[1] == infinity);
}

TEST_CASE("the empty set and the space of dimension 0") {
  for (Index n = 0; n <= 3; ++n) {
    const Polytope none = Polytope::empty(n), all = Polytope::space(n);
    CHECK(none.is_empty());
    CHECK(none.is_bounded());
    CHECK(!all.is_empty());
    CHECK(all.is_bounded() == (n == 0));
    CHECK(all.contains(none));
    CHECK(!none.contains(all));
    CHECK(none == Polytope::from(make_empty(n)));
    CHECK(none == Polytope::from_inequalities(Matrix::Zero(1, n), Vector{{-1.0}}));
    CHECK(none == Polytope::from_generators(Matrix(n, 0)));
    CHECK(all == Polytope::from(make_space(n)));
    CHECK(all == Polytope::from_inequalities(Matrix(0, n), Vector(0)));
    CHECK(all == Polytope::from_inequalities(Matrix::Zero(1, n), Vector{{0.0}}));
    CHECK(none.minkowski_sum(all) == none);
    CHECK(none.convex_hull(all) == all);
    CHECK(all.intersection(none) == none);
    CHECK(none.affine_map(Matrix::Zero(2, n), Vector::Zero(2)).is_empty());
    CHECK(none.support(Vector::Ones(n)).upper == -infinity);
    CHECK(is(none.volume(), 0));
    CHECK(none.cartesian_product(all) == Polytope::empty(2 * n));
    CHECK(exact::is_empty(none.to_line_form().form) == Answer::yes);
    CHECK(none.generators().vertices.cols() == 0);
    CHECK(Polytope::from_inequalities(none.inequalities().H, none.inequalities().h) == none);
    if (n > 0) CHECK(none.interval_hull().is_empty());
  }
  CHECK(is(Polytope::space(0).volume(), 1));
  CHECK(Polytope::space(0).contains(Vector(0)));
  CHECK(is(cube(2).affine_map(Matrix(0, 2), Vector(0)).volume(), 1));
  CHECK(
      Polytope::space(0).affine_map(Matrix(2, 0), Vector{{1.0, 2.0}}).contains(Vector{{1.0, 2.0}}));
}

TEST_CASE("published intersections") {
  // S1 ∩ S2 in R³: |x2| ≤ .1, x1 + x3 ∈ [.9, 1.1]
  const LineForm S1 = make_strip(Vector{{0.0, 1.0, 0.0}}, 0, 0.1),
                 S2 = make_strip(Vector{{1.0, 0.0, 1.0}}, 1, 0.1);
  const Polytope P = Polytope::from(intersection(S1, Matrix::Identity(3, 3), S2));
  CHECK(P == Polytope::from(S1).intersection(Polytope::from(S2)));
  const Polytope::Generators G = P.generators();
  REQUIRE(G.lines.cols() == 1);
  CHECK(G.lines.col(0).cwiseAbs() == Vector{{1.0, 0.0, 1.0}});
  CHECK(G.lines(0, 0) == -G.lines(2, 0));
  CHECK(G.vertices.cols() == 4);
  CHECK(is(P.support(Vector{{0.0, 1.0, 0.0}}), 0.1));
  CHECK(P.support(Vector{{1.0, 0.0, 1.0}}).upper == doctest::Approx(1.1).epsilon(1e-15));

  // a zonotope and a strip [Rego2025, section 3.2.1]
  const LineForm Z =
      make_zonotope(Vector::Zero(2), Matrix{{0.2812, 0.1968, 0.4235}, {0.0186, -0.2063, -0.2267}});
  const Polytope cut =
      Polytope::from(Z).intersection(Polytope::from(make_strip(Vector{{1.0, -1.0}}, 1, 0.1)));
  CHECK(cut.generators().vertices.cols() == 4);
  CHECK(cut.volume().lower == doctest::Approx(0.03680954218666721).epsilon(1e-14));
  CHECK(Polytope::from(Z).volume().upper == doctest::Approx(0.70420268).epsilon(1e-8));
  const Box hull = cut.interval_hull();
  CHECK((hull.lower - Vector{{0.45614173648134015, -0.4438582635186596}}).cwiseAbs().maxCoeff() <
        1e-15);
  CHECK((hull.upper - Vector{{0.7960940957578764, -0.20154916894070946}}).cwiseAbs().maxCoeff() <
        1e-15);
  CHECK(is(
      Polytope::from(make_zonotope(Vector{{-4.0, 1.0}}, Matrix{{-3, -2, -1}, {2, 3, 4}})).volume(),
      80));

  // two constrained zonotopes with known vertices
  LineForm A = make_zonotope(Vector::Zero(2), Matrix{{3, 0, 1}, {0, 2, 1}});
  A.A = Matrix{{1, 0, 1}}, A.S.resize(1, 0), A.b = Vector{{1.0}};
  LineForm B = make_zonotope(Vector::Zero(2), Matrix{{1.5, -1.5, 0.5}, {1, 0.5, -1}});
  B.A = Matrix{{1, 1, 1}}, B.S.resize(1, 0), B.b = Vector{{1.0}};
  const Matrix vertices =
      Polytope::from(intersection(A, Matrix::Identity(2, 2), B)).generators().vertices;
  REQUIRE(vertices.cols() == 4);
  for (const Vector& v : {Vector{{1.0, 1.375}}, Vector{{3.0, -0.125}}, Vector{{1.0, -11.0 / 12}},
                          Vector{{3.0, -7.0 / 12}}}) {
    CHECK((vertices.colwise() - v).colwise().norm().minCoeff() < 1e-15);
  }
}

TEST_CASE("what does not fit is refused, and quickly") {
  CHECK(code_of([] { Polytope::from_inequalities(Matrix::Ones(2, 2), Vector::Ones(1)); }) ==
        Errc::dimension);
  CHECK(code_of([] { Polytope::from_inequalities(Matrix{{std::nan("")}}, Vector{{1.0}}); }) ==
        Errc::not_finite);
  CHECK(code_of([] { Polytope::from_inequalities(Matrix{{1.0}}, Vector{{infinity}}); }) ==
        Errc::not_finite);
  CHECK(code_of([] { Polytope::from_generators(Matrix{{-infinity}}); }) == Errc::not_finite);
  CHECK(code_of([] {
          Polytope::from_generators(Matrix{{1.0}}, Matrix{{std::nan("")}}, Matrix(1, 0));
        }) == Errc::not_finite);
  CHECK(code_of([] { cube(2).contains(Vector{{std::nan(""), 0.0}}); }) == Errc::not_finite);
  CHECK(code_of([] { cube(2).support(Vector{{infinity, 0.0}}); }) == Errc::not_finite);
  CHECK(code_of([] {
          cube(2).affine_map(Matrix{{1.0, infinity}}, Vector{{0.0}});
        }) == Errc::not_finite);
  CHECK(code_of([] {
          cube(2).preimage(Matrix{{1.0}, {1.0}}, Vector{{0.0, std::nan("")}});
        }) == Errc::not_finite);
  CHECK(code_of([] { cube(2).contains(Vector::Zero(3)); }) == Errc::dimension);
  CHECK(code_of([] { cube(2).contains(cube(3)); }) == Errc::dimension);
  CHECK(code_of([] { cube(2).intersection(cube(3)); }) == Errc::dimension);
  CHECK(code_of([] { cube(2).minkowski_sum(cube(3)); }) == Errc::dimension);
  CHECK(code_of([] { cube(2).convex_hull(cube(3)); }) == Errc::dimension);
  CHECK(!(cube(2) == cube(3)));
  CHECK(code_of([] { cube(20).is_empty(); }) == Errc::unsupported);
  CHECK(code_of([] { Polytope::from(make_zonotope(Vector::Zero(6), Matrix::Random(6, 40))); }) ==
        Errc::unsupported);
  CHECK(code_of([] { cube(7).volume(); }) == Errc::unsupported);
  const Polytope many = cube(8).affine_map(Matrix::Random(2, 8), Vector::Zero(2));
  CHECK(many.generators().vertices.cols() == 16);
  CHECK(code_of([] { cube(8).minkowski_sum(cube(8)); }) == Errc::unsupported);
  CHECK(code_of([] { cube(1).affine_map(Matrix{{1e308}}, Vector{{1e308}}).generators(); }) ==
        Errc::not_finite);
}

TEST_CASE("a budget ends what takes more, and counts the same again") {
  const auto sum = [](double operations) {
    const ExactBudget budget(operations);
    const Polytope round = cube(4).minkowski_sum(cross_polytope(4));
    const double spent = round.is_empty() ? -1 : budget.spent();
    CHECK(round.contains(Vector::Zero(4)));
    return spent;
  };
  const double needed = sum(1e9);
  CHECK(needed > 1000);
  CHECK(needed == sum(1e9));
  CHECK(code_of([&] { sum(needed / 2); }) == Errc::unsupported);
  try {
    const ExactBudget outer(needed / 2);
    sum(1e9);  // counts for both
    FAIL("nothing was refused");
  } catch (const Error& error) {
    CHECK(std::string(error.what()).find("limit of exact work") != std::string::npos);
  }
  CHECK(sum(1e9) == needed);  // those before are gone
}

TEST_CASE("a watch looks at work, and ends it") {
  int looked = 0;
  const auto work = [] { return cube(4).minkowski_sum(cross_polytope(4)).is_empty(); };
  {
    const ExactWatch watch([&] { ++looked; });
    CHECK(!work());
  }
  CHECK(looked > 3);
  const int before = looked;
  CHECK(!work());  // that one is gone
  CHECK(looked == before);
  struct Ended {};
  const ExactWatch watch([] { throw Ended(); });
  CHECK_THROWS_AS(work(), Ended);
}

TEST_CASE("rounding a line sets its coordinates free") {
  const double odd = 1 + std::exp2(-50);
  const Polytope line = Polytope::from_generators(Matrix{{0.0}, {0.0}, {1.0}}, Matrix(3, 0),
                                                  Matrix{{1.0}, {odd * odd}, {0.0}});
  CHECK(line.to_line_form().tightness == Tightness::exact);  // odd² was rounded before
  const Polytope turned =
      line.affine_map(Matrix{{1, 0, 0}, {0, odd, 0}, {0, 0, 1}}, Vector::Zero(3));
  const Polytope::Export out = turned.to_line_form();
  CHECK(out.tightness == Tightness::outer);
  CHECK(Polytope::from(out.form) ==
        Polytope::from_inequalities(Matrix(0, 3), Vector(0), Matrix{{0, 0, 1}}, Vector{{1.0}}));
}

TEST_CASE("threads share polytopes") {
  const Polytope shared = cube(4).minkowski_sum(cross_polytope(4));
  std::atomic<int> wrong = 0;
  const auto work = [&](int seed) {
    for (int i = 0; i < 20; ++i) {
      const Vector d = Vector::Constant(4, seed + i);
      if (!is(shared.support(d), 5.0 * (seed + i))) ++wrong;
      if (!is(cube(3).volume(), 8) || !shared.contains(cube(4))) ++wrong;
      if (exact::is_empty(make_strip(d, 1, 1)) != Answer::no) ++wrong;
    }
  };
  std::thread first(work, 1), second(work, 2);
  first.join();
  second.join();
  CHECK(wrong == 0);
}

TEST_CASE("the exchange form has no rows that say nothing") {
  const Polytope flat = Polytope::from_generators(Matrix{{0., 1., 0.}, {0., 0., 1.}, {.5, .5, .5}});
  const Polytope::Export out = flat.to_line_form();
  CHECK(out.tightness == Tightness::exact);
  CHECK(out.form.constraints() == 1);  // x1 + x2 ≤ 1; x3 = .5 is the centre's
  for (Index i = 0; i < out.form.constraints(); ++i) CHECK_FALSE(out.form.A.row(i).isZero(0));
  CHECK(Polytope::from(out.form) == flat);
  const Polytope point = Polytope::from_generators(Matrix{{1.}, {2.}});
  CHECK(point.to_line_form().form.constraints() == 0);
}
