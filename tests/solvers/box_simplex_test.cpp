// SPDX-License-Identifier: GPL-3.0-or-later
// The dual simplex method for boxed programs and its certified proposals, against rational
// arithmetic.
#include "solvers/box_simplex.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/lp.hpp"
#include "solvers/basis_guess.hpp"
#include "solvers/box_solver.hpp"
#include "solvers/exact_program.hpp"
#include "solvers/random_programs.hpp"
#include "solvers/row_certificates.hpp"
#include "solvers/row_gram.hpp"

using namespace cordon;
using namespace solvers_test;

namespace {

ExactProgram::Result exact_maximum(const Program& p) {
  return ExactProgram{Matrix(p.b.size(), 0), p.A, rational::exact(p.b), {}, rational::exact(p.g)}
      .maximum();
}

int programs_asked() {
  const char* count = std::getenv("CORDON_PROGRAMS");
  return count ? std::atoi(count) : 4000;
}

}  // namespace

TEST_CASE("proposals for random programs are certified, and are the exact optimum") {
  Programs programs(1);
  int feasible = 0, infeasible = 0, loose = 0, unproven = 0;
  for (int k = 0; k < programs_asked(); ++k) {
    const Program p = programs.next();
    const ExactProgram::Result exact = exact_maximum(p);
    BoxSolver solver(p.A, p.b);
    const BoxSolver::Status status = solver.maximize(p.g);
    REQUIRE(status != BoxSolver::Status::unsolved);
    const Vector error = Vector::Zero(p.b.size());
    const RowCertificates certificates(p.A, p.b, error);
    const Vector& y = solver.multipliers();
    if (exact.status == ExactProgram::Status::infeasible) {
      ++infeasible;
      unproven += status != BoxSolver::Status::infeasible || certificates.farkas_margin(y) <= 0;
      continue;
    }
    ++feasible;
    const double upper =
        status == BoxSolver::Status::optimal ? certificates.upper_bound(p.g, y) : p.g.lpNorm<1>();
    CHECK(rational::exact(upper) >= exact.value);
    CHECK(certificates.farkas_margin(y) <= 0);
    loose += upper - exact.value.get_d() > 1e-12 * size_of(p, y) + 1e-300;
  }
  MESSAGE(feasible, " feasible, ", infeasible, " infeasible; bounds that are loose: ", loose,
          ", infeasible and unproven: ", unproven);
  CHECK(feasible > programs_asked() / 2);
  CHECK(infeasible > programs_asked() / 20);
  CHECK(loose <= programs_asked() / 2000);
  CHECK(unproven <= programs_asked() / 2000);
}

TEST_CASE("whole questions about random programs agree with rational arithmetic") {
  Programs programs(2);
  int unknown = 0;
  for (int k = 0; k < programs_asked() / 4; ++k) {
    const Program p = programs.next();
    const ExactProgram::Result exact = exact_maximum(p);
    BoxedProgram program(p.A, p.b);
    const BoxedProgram::Bound bound = program.maximum(p.g);
    const Answer empty = program.is_empty();
    unknown += empty == Answer::unknown;
    if (exact.status == ExactProgram::Status::infeasible) {
      CHECK(empty != Answer::no);
      continue;
    }
    CHECK(empty != Answer::yes);
    REQUIRE(std::isfinite(bound.upper));
    CHECK(rational::exact(bound.upper) >= exact.value);
    const double low =
        bound.xi ? program.lower_support(p.g, *bound.xi) : -std::numeric_limits<double>::infinity();
    if (std::isfinite(low)) CHECK(rational::exact(low) <= exact.value);
  }
  MESSAGE("unknown: ", unknown, " of ", programs_asked() / 4);
}

TEST_CASE("the same question has the same answer whatever was asked before") {
  std::mt19937_64 engine(3);
  const Matrix A = random_matrix(engine, 10, 40), G = random_matrix(engine, 40, 12);
  const Vector b = A * (.7 * random_matrix(engine, 40, 1));
  BoxedProgram one(A, b);
  for (Index i = 0; i < G.cols(); ++i) {
    const BoxedProgram::Bound asked_later = one.maximum(G.col(i)),
                              alone = BoxedProgram(A, b).maximum(G.col(i));
    CHECK(asked_later.upper == alone.upper);
    CHECK(asked_later.y == alone.y);
    CHECK(*asked_later.xi == *alone.xi);
  }
}

TEST_CASE("large programs: another solver finds no better bound") {
  std::mt19937_64 engine(4);
  for (const auto& [m, g] : {std::pair<Index, Index>{20, 100}, {50, 200}, {70, 200}, {30, 31}}) {
    const Matrix A = random_matrix(engine, m, g);
    const Vector b = A * (.7 * random_matrix(engine, g, 1)), error = Vector::Zero(m),
                 one = Vector::Ones(g);
    const RowCertificates certificates(A, b, error);
    LinearProgram other(A, b, -one, one);
    BoxSolver solver(A, b);
    for (int k = 0; k < 5; ++k) {
      const Vector objective = random_matrix(engine, g, 1);
      REQUIRE(solver.maximize(objective) == BoxSolver::Status::optimal);
      const double upper = certificates.upper_bound(objective, solver.multipliers());
      Vector xi;
      solver.take_point(xi);
      CHECK((A * xi - b).lpNorm<Eigen::Infinity>() < 1e-9);
      CHECK(xi.lpNorm<Eigen::Infinity>() < 1 + 1e-8);
      CHECK(upper - objective.dot(xi) < 1e-8);
      CHECK(certificates.upper_bound(objective, other.maximize(objective).y) > upper - 1e-8);
    }
  }
}

TEST_CASE("a search that is told what is enough stops there with a proof") {
  std::mt19937_64 engine(5);
  const Matrix A = random_matrix(engine, 20, 100);
  const Vector b = A * (.7 * random_matrix(engine, 100, 1)), g = random_matrix(engine, 100, 1),
               error = Vector::Zero(20);
  BoxSolver solver(A, b);
  REQUIRE(solver.maximize(g) == BoxSolver::Status::optimal);
  const RowCertificates certificates(A, b, error);
  const double best = certificates.upper_bound(g, solver.multipliers());
  for (const double beyond : {1.001, 1.1, 1.5}) {
    REQUIRE(solver.maximize(g, beyond * best) == BoxSolver::Status::below);
    CHECK(certificates.upper_bound(g, solver.multipliers()) < beyond * best);
  }
  CHECK(solver.maximize(g, .999 * best) == BoxSolver::Status::optimal);
}

TEST_CASE("a guess of the basis saves iterations, a bad one costs none of the answer") {
  std::mt19937_64 engine(6);
  const Matrix A = random_matrix(engine, 50, 200);
  const Vector b = A * (.7 * random_matrix(engine, 200, 1)), g = random_matrix(engine, 200, 1);
  BoxSimplex simplex(A, b);
  BasisGuess guess(A, b);
  REQUIRE(simplex.maximize(g, guess.scores(g)) == BoxSimplex::Status::optimal);
  const Index guessed = simplex.iterations();
  Vector xi;
  simplex.take_point(xi);
  const double value = g.dot(xi);
  REQUIRE(simplex.maximize(g, Vector::Zero(200)) == BoxSimplex::Status::optimal);
  simplex.take_point(xi);
  CHECK(g.dot(xi) == doctest::Approx(value).epsilon(1e-9));
  CHECK(3 * guessed < simplex.iterations());
}

TEST_CASE("an objective of one variable does not lead around in circles") {
  // Nearly all reduced costs vanish: every basis shows the same bound, until one is found whose
  // values keep to theirs.
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int round = 0; round < 10; ++round) {
    CAPTURE(round);
    const Index m = 24, g = 300;
    Matrix A(m, g);
    Vector xi(g);
    for (double& a : A.reshaped()) a = number(engine);
    for (Index j = 0; j < g; ++j) {
      A.col(j) *= std::pow(10, -1.5 * (1 + number(engine)));
      xi[j] = .95 * number(engine);
    }
    const Vector b = A * xi;
    BoxSimplex simplex(A, b);
    BasisGuess guess(A, b);
    Index iterations = 0;
    for (Index j = 0; j < 12; ++j) {
      const Vector objective = Vector::Unit(g, 25 * j);
      CHECK(simplex.maximize(objective, guess.scores(objective)) == BoxSimplex::Status::optimal);
      iterations += simplex.iterations();
      const double upper =
          RowCertificates(A, b, Vector::Zero(m)).upper_bound(objective, simplex.multipliers());
      Vector point;
      simplex.take_point(point);
      CHECK(point.cwiseAbs().maxCoeff() <= 1 + 1e-8);
      CHECK(std::abs(upper - objective.dot(point)) <= 1e-9);
    }
    CHECK(iterations <= 12 * 6 * m);
  }
}

TEST_CASE("hostile programs end in a proof or in none, never in a wrong one") {
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               inf = std::numeric_limits<double>::infinity();
  SUBCASE("without variables") {
    BoxedProgram idle(Matrix(2, 0), Vector::Zero(2)), wrong(Matrix(2, 0), Vector{{0, 1e-3}});
    CHECK(idle.is_empty() == Answer::no);
    CHECK(idle.maximum(Vector(0)).upper >= 0);
    CHECK(wrong.is_empty() == Answer::yes);
    CHECK(wrong.maximum(Vector(0)).upper == -inf);
    CHECK_FALSE(wrong.central_point());
  }
  SUBCASE("a right-hand side beyond the range of single precision") {
    const Matrix A{{1, 2, 3}, {1, -1, .5}};
    for (const double far : {1e39, 1e200, 1e307}) {
      BoxedProgram program(A, Vector{{far, 0}});
      CHECK(program.is_empty() == Answer::yes);
      CHECK(program.maximum(Vector{{1, 1, 1}}).upper == -inf);
    }
  }
  SUBCASE("the last bit beside the edge proves nothing") {
    for (const double b : {1.0, 1 + 0x1p-52, 1 - 0x1p-53, 1 + 1e-12}) {
      BoxedProgram program(Matrix{{.25, .25, .5}}, Vector{{b}});
      CHECK(program.is_empty() != Answer::yes);
      CHECK(program.maximum(Vector{{1, 1, 1}}).upper >= 3);
    }
    CHECK(BoxedProgram(Matrix{{.25, .25, .5}}, Vector{{1 + 1e-8}}).is_empty() == Answer::yes);
    CHECK(BoxedProgram(Matrix{{.25, .25, .5}}, Vector{{1 + 0x1p-52}}).is_empty() != Answer::no);
  }
  SUBCASE("scores and multipliers that are no numbers") {
    const Matrix A{{1, 2, 3, -1}, {1, -1, .5, 2}};
    const Vector b{{.5, .25}}, g{{1, 2, 3, 4}}, none = Vector::Zero(2);
    BoxSimplex simplex(A, b);
    REQUIRE(simplex.maximize(g, Vector::Zero(4)) == BoxSimplex::Status::optimal);
    const double best = simplex.objective();
    for (const Vector& scores :
         {Vector{{nan, nan, nan, nan}}, Vector{{nan, 1, inf, -inf}}, Vector{{3, nan, 2, nan}}}) {
      REQUIRE(simplex.maximize(g, scores) == BoxSimplex::Status::optimal);
      CHECK(simplex.objective() == doctest::Approx(best));
    }
    CHECK(simplex.maximize(Vector{{nan, 1, 1, 1}}, Vector::Zero(4)) ==
          BoxSimplex::Status::unsolved);
    const RowCertificates certificates(A, b, none);
    for (const Vector& y : {Vector{{nan, 0}}, Vector{{inf, 0}}, Vector{{1e308, 1e308}}}) {
      CHECK_FALSE(certificates.farkas_margin(y) > 0);
      CHECK_FALSE(certificates.upper_bound(g, y) < best);
    }
    const RowGram gram(A, b, none);
    REQUIRE(gram.is_regular());
    CHECK_FALSE(gram.distance(Vector{{nan, 0, 0, 0}}) <= 1);
    CHECK_FALSE(gram.distance(Vector{{inf, 0, 0, 0}}) <= 1);
  }
}

TEST_CASE(
    "a question of feasibility in exact arithmetic takes a few pivots per row, not hundreds") {
  // Corners of the box a little too far out: nothing but ties among the costs, which are all 0.
  int infeasible = 0;
  for (const unsigned seed : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}) {
    std::mt19937_64 engine(seed);
    const auto uniform = [&] { return 2 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1; };
    const Index rows = 20, columns = 56;
    Matrix A(rows, columns);
    for (Index i = 0; i < rows; ++i) {
      for (Index j = 0; j < columns; ++j)
        A(i, j) = std::ldexp(uniform(), -static_cast<int>(engine() % 40));
    }
    const Vector corner =
        1.02 * Vector::NullaryExpr(columns, [&] { return uniform() < 0 ? -1. : 1.; });
    Program p{A, A * corner, Vector::Zero(columns)};
    const ExactProgram::Result exact = exact_maximum(p);
    infeasible += exact.status == ExactProgram::Status::infeasible;
    CHECK(exact.pivots <= 5 * rows);
    // The share of the right-hand side that can be met says the same.
    Matrix with_share(rows, columns + 1);
    with_share << p.A, -p.b;
    const ExactProgram::Result share =
        exact_maximum({with_share, Vector::Zero(rows), Vector::Unit(columns + 1, columns)});
    CHECK(share.status == ExactProgram::Status::optimal);
    CHECK((share.value == 1) == (exact.status == ExactProgram::Status::optimal));
    CHECK(share.pivots <= 5 * rows);
  }
  CHECK(infeasible >= 3);
}
