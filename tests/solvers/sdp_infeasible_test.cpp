// SPDX-License-Identifier: GPL-3.0-or-later
// Semidefinite programs without a solution: each is proven, and none that has one.
#include <cmath>
#include <random>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/linalg.hpp"
#include "cordon/sdp/sdp.hpp"
#include "solvers/sdp_programs.hpp"

using namespace cordon;
using namespace solvers_test;

namespace {

Matrix random_definite(Index n, std::mt19937_64& engine) {
  const Matrix S = random_symmetric(n, engine);
  return S * S.transpose() + .1 * Matrix::Identity(n, n);
}

/// ⟨constant, Y⟩ = -1 and ⟨F_i, Y⟩ = 0, summed over 1 to 3 inequalities of size 2 to 6, for 1 to 12
/// variables and a random Y ⪰ 0, of less than full rank if `on_a_face`; rows and variables in units
/// between 10^-spread and 10^spread.
SemidefiniteProgram infeasible_program(std::uint64_t seed, double spread, bool on_a_face) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto m = static_cast<Index>(1 + engine() % 12),
             blocks = static_cast<Index>(1 + engine() % 3);
  const auto symmetric = [](const Matrix& F) { return Matrix((F + F.transpose()) / 2); };
  SemidefiniteProgram program;
  program.cost = Vector::Ones(m);
  std::vector<Matrix> Y;
  std::vector<Vector> units;
  double norm = 0;
  for (Index j = 0; j < blocks; ++j) {
    const auto n = static_cast<Index>(2 + engine() % 5);
    Matrix S = Matrix::NullaryExpr(n, n, [&] { return uniform(engine); });
    if (on_a_face)
      S.rightCols(n - static_cast<Index>(1 + engine() % static_cast<std::uint64_t>(n))).setZero();
    Y.push_back(symmetric(S * S.transpose() + (on_a_face ? 0. : .1) * Matrix::Identity(n, n)));
    norm += Y.back().squaredNorm();
    units.push_back(
        Vector::NullaryExpr(n, [&] { return std::pow(10., spread * uniform(engine)); }));
    program.inequalities.push_back({Matrix::Zero(n, n), {}});
  }
  for (Index i = -1; i < m; ++i) {
    std::vector<Matrix> F;
    double sum = 0;
    for (const Matrix& part : Y) {
      const Matrix R =
          Matrix::NullaryExpr(part.rows(), part.rows(), [&] { return uniform(engine); });
      F.push_back(symmetric(R));
      sum += F.back().cwiseProduct(part).sum();
    }
    const double unit = i < 0 ? 1 : std::pow(10., spread * uniform(engine));
    for (std::size_t j = 0; j < Y.size(); ++j) {
      F[j] += ((i < 0 ? -1 : 0) - sum) / norm * Y[j];
      F[j] = unit * symmetric(units[j].asDiagonal() * F[j] * units[j].asDiagonal());
      if (i < 0) {
        program.inequalities[j].constant = F[j];
      } else {
        program.inequalities[j].terms.emplace_back(i, F[j]);
      }
    }
  }
  return program;
}

}  // namespace

TEST_CASE("infeasible programs are proven infeasible") {
  check_proof(contradiction(), solve(contradiction()), 1e8);
  // [x 1; 1 -x] ⪰ 0 is impossible.
  const SemidefiniteProgram program{Vector::Ones(1),
                                    {{Matrix{{0, 1}, {1, 0}}, {{0, Matrix{{1, 0}, {0, -1}}}}}}};
  check_proof(program, solve(program), 1e8);
}

TEST_CASE("proofs on a face: Y is semidefinite for the numbers themselves") {
  std::mt19937_64 engine(5);
  for (int i = 0; i < 40; ++i) {
    // [x 1; 1 -x] ⪰ 0 in other coordinates, beside what is always met.
    const Index n = 2 + i % 4;
    Matrix constant = Matrix::Identity(n, n), term = Matrix::Zero(n, n);
    constant.topLeftCorner(2, 2) = Matrix{{0, 1}, {1, 0}};
    term.topLeftCorner(2, 2) = Matrix{{1, 0}, {0, -1}};
    const Matrix V = random_symmetric(n, engine);
    const auto turned = [&](const Matrix& F) {
      const Matrix product = V * F * V;
      return Matrix((product + product.transpose()) / 2);
    };
    const SemidefiniteProgram program{Vector::Ones(1), {{turned(constant), {{0, turned(term)}}}}};
    check_proof(program, solve(program), 1e8);
  }
}

TEST_CASE(
    "terms that depend on each other: a point far away, that seems feasible for its size, hides no "
    "proof") {
  // Up to 8 variables for the two directions beside Y.
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    std::mt19937_64 engine(seed);
    const Matrix Y = random_definite(2, engine);
    const auto with_product = [&](double product) {
      const Matrix F = random_symmetric(2, engine);
      return Matrix(F + (product - F.cwiseProduct(Y).sum()) / Y.squaredNorm() * Y);
    };
    SemidefiniteProgram program{Vector::Ones(static_cast<Index>(3 + seed % 6)),
                                {{with_product(-1), {}}}};
    for (Index i = 0; i < program.cost.size(); ++i)
      program.inequalities[0].terms.emplace_back(i, with_product(0));
    const SdpSolution s = solve(program);
    INFO(seed, s.why);
    CHECK(s.status == SdpStatus::infeasible);
  }
}

TEST_CASE("units of rows and variables hide no proof") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const SdpSolution s = solve(infeasible_program(seed, 2, false));
    INFO(seed, s.why);
    CHECK(s.status == SdpStatus::infeasible);
  }
}

TEST_CASE("proofs on faces") {
  for (std::uint64_t seed = 1400; seed < 1600; ++seed) {
    const SdpSolution s = solve(infeasible_program(seed, 0, true));
    INFO(seed, s.why);
    CHECK(s.status == SdpStatus::infeasible);
  }
}

TEST_CASE(
    "what holds beyond the bound of x only is neither solved nor infeasible without a proof for "
    "the bound") {
  // x ≥ 1000, and nothing else
  const SemidefiniteProgram far{Vector::Ones(1), {{scalar(-1000), {{0, scalar(1)}}}}};
  CHECK(solve(far).status == SdpStatus::solved);
  SdpOptions near;
  near.largest_x = 999;
  check_proof(far, solve(far, near), 999);
  near.largest_x = 1001;
  CHECK(solve(far, near).status == SdpStatus::solved);
}

TEST_CASE("a solver that stops early proves nothing about a program that has a solution") {
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int iterations = 1; iterations <= 15; ++iterations) {
    for (int i = 0; i < 5; ++i) {
      // aᵀx = b as two inequalities: no point that the solver passes through is feasible.
      const Vector a = Vector::NullaryExpr(3, [&] { return uniform(engine); });
      const double b = uniform(engine);
      SemidefiniteProgram program{Vector::Ones(3), {{scalar(-b), {}}, {scalar(b), {}}}};
      for (Index k = 0; k < 3; ++k) {
        program.inequalities[0].terms.emplace_back(k, scalar(a[k]));
        program.inequalities[1].terms.emplace_back(k, scalar(-a[k]));
      }
      CHECK(solve(program, {1e-9, 1e8, iterations}).status != SdpStatus::infeasible);
    }
  }
}

TEST_CASE("random programs that are infeasible by construction are proven so") {
  CHECK(rc::check("⟨F_i, Y⟩ = 0 and ⟨F_0, Y⟩ = -1 for a definite Y", [](std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    const Index m = *rc::gen::inRange<Index>(1, 6), n = *rc::gen::inRange<Index>(2, 6);
    const Matrix Y = random_definite(n, engine);
    const auto without = [&](const Matrix& F, double left) {
      return Matrix(F + (left - F.cwiseProduct(Y).sum()) / Y.squaredNorm() * Y);
    };
    SemidefiniteProgram program;
    program.cost = Vector::Ones(m);
    MatrixInequality F{without(random_symmetric(n, engine), -1), {}};
    F.constant = Matrix((F.constant + F.constant.transpose()) / 2);
    for (Index i = 0; i < m; ++i) {
      const Matrix term = without(random_symmetric(n, engine), 0);
      F.terms.emplace_back(i, Matrix((term + term.transpose()) / 2));
    }
    program.inequalities.push_back(F);
    const SdpSolution s = solve(program);
    RC_ASSERT(s.status == SdpStatus::infeasible);
    check_proof(program, s, 1e8);
  }));
}
