// SPDX-License-Identifier: GPL-3.0-or-later
// Proposals for boxed programs, of which many variables enter no row: those of sets that were
// reduced.
#include "solvers/box_solver.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/solvers/boxed_program.hpp"

using namespace cordon;

namespace {

using Status = BoxSolver::Status;

Matrix arbitrary_matrix(Index rows, Index cols) {
  Matrix A(rows, cols);
  for (double& a : A.reshaped()) a = *rc::gen::inRange(-64, 65) / 64.0;
  return A;
}

/// The columns of A with others between them, all zero or rounding noise.
struct Spread {
  Matrix A;
  std::vector<Index> places;

  Spread(const Matrix& core, Index idle) : A(Matrix::Zero(core.rows(), core.cols() + idle)) {
    const Index kind = *rc::gen::inRange<Index>(0, 2);
    for (double& a : A.reshaped()) a = kind == 0 ? 0 : 1e-16 * *rc::gen::inRange(-9, 10);
    for (Index k = 0, left = idle; k < core.cols(); ++k) {
      const Index passed = *rc::gen::inRange<Index>(0, left + 1);
      left -= passed;
      places.push_back((places.empty() ? 0 : places.back() + 1) + passed);
      A.col(places.back()) = core.col(k);
    }
  }
};

}  // namespace

TEST_CASE("variables that enter no row are put at their bounds, and count in the value") {
  REQUIRE(rc::check([] {
    const Index m = *rc::gen::inRange<Index>(1, 5), cols = m + *rc::gen::inRange<Index>(1, 8);
    Matrix core = arbitrary_matrix(m, cols);
    core.row(0).setOnes();  // so that noise is noise, and the rows are not zero
    core.leftCols(m).diagonal().array() += 2;
    const Vector b = core * (arbitrary_matrix(cols, 1) / 2);
    const Spread spread(core, *rc::gen::inRange<Index>(0, 12));
    const Vector g = arbitrary_matrix(spread.A.cols(), 1);
    Vector of_core(cols), expected(g.size());
    double idle = g.lpNorm<1>();
    for (Index j = 0; j < g.size(); ++j) expected[j] = g[j] < 0 ? -1 : 1;
    for (Index k = 0; k < cols; ++k) {
      of_core[k] = g[spread.places[static_cast<std::size_t>(k)]];
      idle -= std::abs(of_core[k]);
    }

    BoxSolver alone(core, b), among(spread.A, b);
    RC_ASSERT(alone.maximize(of_core) == Status::optimal);
    RC_ASSERT(among.maximize(g) == Status::optimal);
    RC_ASSERT(among.multipliers() == alone.multipliers());
    RC_ASSERT(std::abs(among.value() - alone.value() - idle) <= 1e-12 * (1 + g.lpNorm<1>()));
    Vector point, of_alone;
    among.take_point(point);
    alone.take_point(of_alone);
    for (Index k = 0; k < cols; ++k)
      expected[spread.places[static_cast<std::size_t>(k)]] = of_alone[k];
    RC_ASSERT(point == expected);
    RC_ASSERT(std::abs(g.dot(point) - among.value()) <= 1e-7 * (1 + g.lpNorm<1>()));

    const double value = among.value(), margin = 1e-6 * (1 + g.lpNorm<1>());
    RC_ASSERT(among.maximize(g, value - margin) == Status::optimal);
    RC_ASSERT(among.maximize(g, value + margin) == Status::below);

    RC_ASSERT(among.second_opinion(g) == Status::optimal);
    RC_ASSERT(std::abs(among.value() - value) <= 1e-6 * (1 + g.lpNorm<1>()));
    among.take_point(point);
    RC_ASSERT((spread.A * point - b).cwiseAbs().maxCoeff() <= 1e-6);
    RC_ASSERT(std::abs(g.dot(point) - value) <= 1e-6 * (1 + g.lpNorm<1>()));
  }));
}

TEST_CASE("rows that no variable enters") {
  const Matrix zero = Matrix::Zero(2, 3);
  const Vector g{{1, -2, 0}};
  BoxSolver solver(zero, Vector::Zero(2));
  REQUIRE(solver.maximize(g) == Status::optimal);
  CHECK(solver.value() == 3);
  Vector point;
  solver.take_point(point);
  CHECK(g.dot(point) == 3);
  CHECK(BoxSolver(zero, Vector{{0, 1e-3}}).maximize(g) == Status::infeasible);
  CHECK(BoxedProgram(zero, Vector{{0, 1e-3}}).is_empty() == Answer::yes);
  const double upper = BoxedProgram(zero, Vector::Zero(2)).maximum(g).upper;
  CHECK(upper >= 3);
  CHECK(upper <= 3 * (1 + 1e-14));
}
