// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/boxed_program.hpp"

#include <cmath>
#include <limits>
#include <thread>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/lp.hpp"

using namespace cordon;

namespace {

double number() { return static_cast<double>(*rc::gen::inRange(-100, 101)) / 10; }

struct Program {
  Matrix A;
  Vector b, xi, objective;
};

/// Aξ = b with ‖ξ‖∞ < 1.
Program feasible_program(Index g, Index m) {
  Program p{Matrix(m, g), Vector(m), Vector(g), Vector(g)};
  for (Index k = 0; k < p.A.size(); ++k) p.A.data()[k] = number();
  for (Index j = 0; j < g; ++j) p.xi[j] = static_cast<double>(*rc::gen::inRange(-95, 96)) / 100;
  for (Index j = 0; j < g; ++j) p.objective[j] = number();
  p.b = p.A * p.xi;
  return p;
}

}  // namespace

TEST_CASE("the next doubles are those of the C library") {
  constexpr double inf = std::numeric_limits<double>::infinity(),
                   largest = std::numeric_limits<double>::max(),
                   least = std::numeric_limits<double>::denorm_min(),
                   normal = std::numeric_limits<double>::min();
  for (const double size :
       {0.0, least, normal, normal - least, 1.0, 1.0 - 0x1p-53, 3.7, 1e300, largest}) {
    for (const double x : {size, -size}) {
      CHECK(rounding::up(x) == std::nextafter(x, inf));
      CHECK(rounding::down(x) == std::nextafter(x, -inf));
    }
  }
  CHECK(rounding::up(inf) == inf);
  CHECK(rounding::down(-inf) == -inf);
  CHECK(rounding::down(inf) == largest);  // as the C library has it
  CHECK(rounding::up(-inf) == -largest);
  CHECK(std::isnan(rounding::up(std::nan(""))));
  CHECK(std::isnan(rounding::down(std::nan(""))));
}

TEST_CASE("a plain linear program") {
  LinearProgram lp(Matrix{{1.0, 1.0, 1.0}}, Vector{{1.0}}, Vector{{0.0, 0.0, 0.0}},
                   Vector{{1.0, 2.0, 0.25}});
  auto solution = lp.maximize(Vector{{1.0, 2.0, 3.0}});
  REQUIRE(solution.status == LinearProgram::Status::optimal);
  CHECK(solution.objective == doctest::Approx(0.75 * 2 + 0.25 * 3));
  solution = lp.maximize(Vector{{-1.0, -2.0, -3.0}});
  CHECK(solution.objective == doctest::Approx(-1.0));
  LinearProgram bad(Matrix{{1.0}}, Vector{{3.0}}, Vector{{0.0}}, Vector{{1.0}});
  CHECK(bad.maximize(Vector{{1.0}}).status == LinearProgram::Status::infeasible);
  LinearProgram open(Matrix(0, 1), Vector(0), Vector{{0.0}},
                     Vector{{std::numeric_limits<double>::infinity()}});
  CHECK(open.maximize(Vector{{1.0}}).status == LinearProgram::Status::unbounded);
}

TEST_CASE(
    "a program that is asked on another thread has the same answer, unlike one of the other "
    "solver") {
  BoxedProgram program(Matrix{{1.0, 2.0}}, Vector{{1.0}});
  const double here = program.maximum(Vector{{1.0, -1.0}}).upper;
  BoxedProgram::Bound there;
  std::thread([&] { there = program.maximum(Vector{{1.0, -1.0}}); }).join();
  CHECK(there.solved);
  CHECK(there.upper == here);

  LinearProgram other(Matrix{{1.0, 2.0}}, Vector{{1.0}}, Vector{{-1.0, -1.0}}, Vector{{1.0, 1.0}});
  auto status = LinearProgram::Status::optimal;
  std::thread([&] { status = other.maximize(Vector{{1.0, -1.0}}).status; }).join();
  CHECK(status == LinearProgram::Status::failed);
}

TEST_CASE("numbers that would abort the solver are refused before") {
  CHECK_THROWS_AS(
      LinearProgram(Matrix{{std::nan("")}}, Vector{{0.0}}, Vector{{0.0}}, Vector{{1.0}}), Error);
  CHECK_THROWS_AS(LinearProgram(Matrix{{1.0}}, Vector{{0.0}}, Vector{{2.0}}, Vector{{1.0}}), Error);
  LinearProgram lp(Matrix{{1.0}}, Vector{{0.0}}, Vector{{-1.0}}, Vector{{1.0}});
  CHECK_THROWS_AS(lp.maximize(Vector{{std::nan("")}}), Error);
}

TEST_CASE("bounds hold for any multipliers, and are attained") {
  CHECK(rc::check("upper ≥ attained, and both meet on feasible programs", [] {
    const Index g = *rc::gen::inRange<Index>(1, 12), m = *rc::gen::inRange<Index>(0, 5);
    const auto [A, b, xi, objective] = feasible_program(g, m);
    BoxedProgram program(A, b);
    RC_ASSERT(program.is_empty() != Answer::yes);
    const auto bound = program.maximum(objective);
    RC_ASSERT(bound.upper >= objective.dot(xi) - 1e-9 * (1 + objective.lpNorm<1>()));
    if (bound.xi) {
      const double low = program.lower_support(objective, *bound.xi);
      RC_ASSERT(low <= bound.upper);
      if (std::isfinite(low)) RC_ASSERT(bound.upper - low <= 1e-6 * (1 + objective.lpNorm<1>()));
    }
    // any y gives a bound
    Vector y(m);
    for (Index i = 0; i < m; ++i) y[i] = number();
    const double any =
        rounding::up(rounding::dot(b, y).upper + rounding::residual_norm_1(objective, A, y));
    RC_ASSERT(any >= objective.dot(xi) - 1e-9 * (1 + objective.lpNorm<1>()));
  }));
}

TEST_CASE("bounds are as tight for tiny and huge objectives") {
  CHECK(rc::check("a power of two before the objective stands before the bound", [] {
    const auto [A, b, xi, objective] =
        feasible_program(*rc::gen::inRange<Index>(2, 12), *rc::gen::inRange<Index>(1, 4));
    const auto plain = BoxedProgram(A, b).maximum(objective);
    RC_PRE(plain.solved);
    for (const int power :
         {-60, -30, 40}) {  // on a program of its own: the last basis of another one would help
      const auto scaled = BoxedProgram(A, b).maximum(Vector(std::ldexp(1.0, power) * objective));
      RC_ASSERT(scaled.solved);
      RC_ASSERT(std::abs(std::ldexp(scaled.upper, -power) - plain.upper) <=
                1e-9 * (1 + objective.lpNorm<1>()));
    }
  }));
}

TEST_CASE("emptiness is decided on both sides of the boundary") {
  CHECK(rc::check("rows moved beyond their reach", [] {
    const Index g = *rc::gen::inRange<Index>(1, 10), m = *rc::gen::inRange<Index>(1, 4);
    Matrix A(m, g);
    for (Index k = 0; k < A.size(); ++k)
      A.data()[k] = static_cast<double>(*rc::gen::inRange(-9, 10));
    Vector y(m);
    for (Index i = 0; i < m; ++i) y[i] = static_cast<double>(*rc::gen::inRange(-9, 10));
    RC_PRE(y.squaredNorm() > 0);
    const double reach = (A.transpose() * y).lpNorm<1>();
    // b along y with bᵀy = reach (1 + 1e-6) + 1e-6: outside by construction
    const Vector b = y * ((reach * (1 + 1e-6) + 1e-6) / y.squaredNorm());
    Certificate why;
    RC_ASSERT(BoxedProgram(A, b).is_empty(&why) == Answer::yes);
    RC_ASSERT(farkas_margin(A, b, why.data) > 0);
  }));
}

TEST_CASE("a repaired point is proven, a point that cannot be repaired is not") {
  const Matrix A{{1.0, 1.0, 0.0}, {0.0, 1.0, 1.0}};
  const Vector b{{.5, .25}};
  const auto radius = repair_radius(A, b, Vector{{.25, .25, 0.0}} * (1 + 1e-9));
  REQUIRE(radius);
  CHECK(radius->maxCoeff() < 1e-8);
  CHECK(radius->maxCoeff() > 0);
  CHECK_FALSE(repair_radius(Matrix{{1.0, 1.0}, {1.0, 1.0}}, Vector{{.5, .5}},
                            Vector{{.25, .25}}));  // dependent rows
  CHECK_FALSE(repair_radius(Matrix{{0.0, 0.0}}, Vector{{1.0}}, Vector{{0.0, 0.0}}));
}

TEST_CASE("rows of subnormal numbers are no proof that a set is empty") {
  LineForm set = make_box(Box{Vector::Constant(1, -1), Vector::Constant(1, 1)});
  for (const double size : {1.0, 1e-200, 1e-312}) {
    set.A = Matrix::Constant(1, set.G.cols(), size);
    set.b = Vector::Constant(1, 1.5 * size);  // no factor is 1.5
    set.S = Matrix(1, 0);
    CAPTURE(size);
    CHECK(is_empty(set) == (size > 1e-300 ? Answer::yes : Answer::unknown));
  }
}
