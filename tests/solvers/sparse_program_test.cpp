// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/sparse_program.hpp"

#include <random>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"

using namespace cordon;
using Status = LinearProgram::Status;

namespace {

/// minimise x₀ + x₁ subject to x₀ + 2 x₁ ≥ 3, x₀ - x₁ = 0, x ≥ 0.
SparseProgram program() {
  SparseProgram p;
  p.cost = Vector{{1, 1}};
  p.entries = {{0, 0, 1}, {0, 1, 2}, {1, 0, 1}, {1, 1, -1}};
  p.row_lower = Vector{{3, 0}};
  p.row_upper = Vector{{infinity, 0}};
  p.lower = Vector::Zero(2);
  p.upper = Vector::Constant(2, infinity);
  return p;
}

}  // namespace

TEST_CASE("a sparse program of two rows: optimum and multipliers") {
  const auto solution = minimize(program(), 10);
  REQUIRE(solution.status == Status::optimal);
  CHECK(solution.objective == doctest::Approx(2));
  CHECK(solution.x[0] == doctest::Approx(1));
  CHECK(solution.y[0] == doctest::Approx(2.0 / 3));
  CHECK(solution.y[1] == doctest::Approx(1.0 / 3));
}

TEST_CASE("sparse programs without solution or without bound say so") {
  SparseProgram none = program();
  none.upper = Vector::Constant(2, 0.5);
  CHECK(minimize(none, 10).status == Status::infeasible);
  SparseProgram open = program();
  open.cost = Vector{{-1, -1}};
  CHECK(minimize(open, 10).status != Status::optimal);
}

TEST_CASE("random sparse programs: the multipliers prove the optimum") {
  std::mt19937_64 random(1);
  const auto any = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  for (int i = 0; i < 100; ++i) {
    CAPTURE(i);
    const Index m = 3 + i % 9, n = m + 2;
    SparseProgram p;
    Matrix A = Matrix::Zero(m, n);
    Vector inside(n);
    for (double& x : inside) x = any();
    for (Index row = 0; row < m; ++row)
      for (Index col = 0; col < n; ++col)
        if (any() > 0.2) p.entries.push_back({row, col, A(row, col) = any()});
    p.cost.resize(n);
    for (double& c : p.cost) c = any();
    p.row_lower = p.row_upper = A * inside;
    p.lower = Vector::Constant(n, -1), p.upper = Vector::Ones(n);
    const auto solution = minimize(p, 10);
    REQUIRE(solution.status == Status::optimal);
    const Vector rest = p.cost - A.transpose() * solution.y;
    CHECK(p.row_lower.dot(solution.y) - rest.cwiseAbs().sum() ==
          doctest::Approx(solution.objective).epsilon(1e-6));
    CHECK((A * solution.x - p.row_lower).cwiseAbs().maxCoeff() < 1e-7);
  }
}

TEST_CASE("broken sparse programs are refused") {
  SparseProgram p = program();
  p.entries.push_back({2, 0, 1});
  CHECK_THROWS_AS(minimize(p, 1), Error);
  p = program();
  p.entries[0].value = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(minimize(p, 1), Error);
  p = program();
  p.lower[0] = 2, p.upper[0] = 1;
  CHECK_THROWS_AS(minimize(p, 1), Error);
}
