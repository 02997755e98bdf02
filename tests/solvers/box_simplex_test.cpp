// SPDX-License-Identifier: GPL-3.0-or-later
// The dual simplex method for boxed programs and what certifies its proposals, against rational
// arithmetic.
#include "solvers/box_simplex.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/lp.hpp"
#include "solvers/basis_guess.hpp"
#include "solvers/box_solver.hpp"
#include "solvers/exact_program.hpp"
#include "solvers/row_certificates.hpp"
#include "solvers/row_gram.hpp"

using namespace cordon;

namespace {

struct Program {
  Matrix A;
  Vector b, g;
};

/// Dense, sparse, of small integers, badly scaled, with dependent rows, zero rows or repeated
/// columns; some infeasible.
class Programs {
 public:
  explicit Programs(std::uint64_t seed) : engine_(seed) {}

  Program next() {
    const Index m = below(6) + 1, g = below(14) + 1;
    const Index kind = below(6);
    Program p{entries(m, g, kind), Vector(m), entries(g, 1, kind)};
    if (m > 1 && one_in(4)) p.A.row(m - 1) = p.A.row(0) * static_cast<double>(below(5) - 2);
    if (m > 2 && one_in(4)) p.A.row(m - 1) = p.A.row(0) - p.A.row(1);
    if (g > 1 && one_in(4)) p.A.col(g - 1) = p.A.col(0);
    const Matrix xi =
        entries(g, 1, one_in(2) ? 1 : 0);  // integers put ξ onto its bounds: degenerate programs
    p.b = p.A * xi.cwiseMax(-1).cwiseMin(1);
    if (one_in(4)) p.b *= 1 + 3 * uniform();
    if (one_in(8)) p.b = entries(m, 1, kind);
    if (kind == 5) scale(p);
    return p;
  }

 private:
  Index below(Index n) { return static_cast<Index>(engine_() % static_cast<std::uint64_t>(n)); }
  bool one_in(Index n) { return below(n) == 0; }
  /// Of six bits, so that sums and products of the data are exact: no program is infeasible by a
  /// rounding error.
  double uniform() { return static_cast<double>(below(129) - 64) / 64; }

  Matrix entries(Index rows, Index cols, Index kind) {
    Matrix A(rows, cols);
    for (double& a : A.reshaped()) {
      a = kind == 1   ? static_cast<double>(below(5) - 2)
          : kind == 2 ? (one_in(2) ? 0 : uniform())
          : kind == 3 ? std::ldexp(uniform(), static_cast<int>(below(11)) - 5)
                      : uniform();
    }
    return A;
  }

  void scale(Program& p) {
    for (Index i = 0; i < p.b.size(); ++i) {
      const double factor = std::ldexp(1.0, static_cast<int>(below(81)) - 40);
      p.A.row(i) *= factor;
      p.b[i] *= factor;
    }
    p.g *= std::ldexp(1.0, static_cast<int>(below(81)) - 40);
  }

  std::mt19937_64 engine_;
};

ExactProgram::Result exact_maximum(const Program& p) {
  return ExactProgram{Matrix(p.b.size(), 0), p.A, rational::exact(p.b), {}, rational::exact(p.g)}
      .maximum();
}

/// What rounding in the coefficients may hide: the sum of all terms.
double size_of(const Program& p, const Vector& y) {
  return p.g.lpNorm<1>() + y.cwiseAbs().dot(p.b.cwiseAbs() + p.A.cwiseAbs().rowwise().sum());
}

int programs_asked() {
  const char* count = std::getenv("CORDON_PROGRAMS");
  return count ? std::atoi(count) : 4000;
}

Matrix random_matrix(std::mt19937_64& engine, Index rows, Index cols) {
  Matrix A(rows, cols);
  for (double& a : A.reshaped()) a = static_cast<double>(engine() >> 11) * 0x1p-52 - 1;
  return A;
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
        bound.xi ? program.attained(p.g, *bound.xi) : -std::numeric_limits<double>::infinity();
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

TEST_CASE("multipliers of any kind prove no more than is true") {
  Programs programs(7);
  std::mt19937_64 engine(8);
  for (int k = 0; k < 300; ++k) {
    const Program p = programs.next();
    const Vector y = random_matrix(engine, p.b.size(), 1),
                 error = random_matrix(engine, p.b.size(), 1).cwiseAbs() * 1e-3;
    const RowCertificates certificates(p.A, p.b, error);
    rational::Rational gain = rational::dot(rational::exact(p.b), rational::exact(y)), plain = 0,
                       shifted = 0, doubt = 0;
    for (Index i = 0; i < y.size(); ++i)
      doubt += rational::exact(error[i]) * abs(rational::exact(y[i]));
    for (Index j = 0; j < p.g.size(); ++j) {
      const rational::Rational column =
          rational::dot(rational::exact(p.A.col(j)), rational::exact(y));
      plain += abs(column);
      shifted += abs(rational::exact(p.g[j]) - column);
    }
    const double margin = certificates.farkas_margin(y), upper = certificates.upper_bound(p.g, y);
    const double size = size_of(p, y);
    CHECK(rational::exact(margin) <= gain - plain - doubt);
    CHECK(rational::exact(upper) >= gain + shifted + doubt);
    CHECK(rational::Rational(gain - plain - doubt).get_d() - margin <= 1e-13 * size);
    CHECK(upper - rational::Rational(gain + shifted + doubt).get_d() <= 1e-13 * size);
  }
}

TEST_CASE("a solution of the rows lies as near as the factor says") {
  std::mt19937_64 engine(9);
  for (const auto& [m, g] : {std::pair<Index, Index>{1, 3}, {5, 30}, {20, 21}, {50, 200}}) {
    const Matrix A = random_matrix(engine, m, g);
    const Vector b = A * (.5 * random_matrix(engine, g, 1)), error = Vector::Zero(m);
    const RowGram gram(A, b, error);
    REQUIRE(gram.is_regular());
    const RowGram::Point point = gram.least_squares();
    CHECK((A.transpose() * point.y - point.xi).lpNorm<Eigen::Infinity>() < 1e-9);
    CHECK(gram.distance(point.xi) < 1e-5);
    // moved off the rows, the nearest solution is the orthogonal one: no claim may be smaller than
    // its distance
    const Vector moved = point.xi + 1e-3 * random_matrix(engine, g, 1);
    const Vector back = A.transpose() * *linalg::solve_spd(A * A.transpose(), b - A * moved);
    CHECK(gram.distance(moved) >= back.lpNorm<Eigen::Infinity>());
    CHECK(RowGram(A, b, Vector::Constant(m, 1e-3)).distance(point.xi) >
          1e-3 / A.rowwise().norm().maxCoeff());
  }
  CHECK_FALSE(RowGram(Matrix{{1, 2}, {2, 4}}, Vector{{1, 2}}, Vector::Zero(2)).is_regular());
  CHECK_FALSE(RowGram(Matrix{{0, 0}}, Vector{{1}}, Vector::Zero(1)).is_regular());
  CHECK_FALSE(RowGram(Matrix{{0, 0}}, Vector{{0}}, Vector{{1e-9}}).is_regular());
  const RowGram idle(Matrix{{0, 0}}, Vector{{0}}, Vector::Zero(1));
  REQUIRE(idle.is_regular());
  CHECK(idle.least_squares().xi == Vector::Zero(2));
  CHECK(idle.distance(Vector{{.5, .5}}) == 0);
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
