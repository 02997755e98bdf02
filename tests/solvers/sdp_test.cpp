// SPDX-License-Identifier: GPL-3.0-or-later
// Semidefinite programs with known answers, broken ones, and the solver's manners.
#include "cordon/sdp/sdp.hpp"

#include <cmath>
#include <cstdio>
#include <fcntl.h>
#include <iostream>
#include <limits>
#include <random>
#include <thread>
#include <unistd.h>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "solvers/sdp_programs.hpp"

using namespace cordon;
using namespace solvers_test;
using doctest::Approx;

namespace {

Matrix evaluate(const MatrixInequality& F, const Vector& x) {
  Matrix value = F.constant;
  for (const auto& [i, term] : F.terms) value += x[i] * term;
  return value;
}

/// Meets the inequalities, costs what is said, and the dual side agrees.
void check_solved(const SemidefiniteProgram& program, const SdpSolution& s) {
  INFO(s.why);
  REQUIRE(s.status == SdpStatus::solved);
  REQUIRE(s.x.size() == program.cost.size());
  CHECK(s.value == Approx(program.cost.dot(s.x)).epsilon(1e-14));
  CHECK(std::abs(s.value - s.bound) <= 1e-6 * (1 + std::abs(s.value)));
  REQUIRE(s.least_eigenvalue.size() == program.inequalities.size());
  for (std::size_t j = 0; j < program.inequalities.size(); ++j) {
    const double least = linalg::symmetric_eigen(evaluate(program.inequalities[j], s.x)).values[0];
    CHECK(least == Approx(s.least_eigenvalue[j]).epsilon(1e-9));
    CHECK(least >= -1e-6 * (1 + s.x.cwiseAbs().maxCoeff()));
  }
}

/// What reaches the file descriptors 1 and 2 while `work` runs.
template <class Work>
std::string printed(Work work) {
  std::fflush(nullptr);
  std::cout.flush();
  std::FILE* file = std::tmpfile();
  const int out = dup(1), err = dup(2);
  dup2(fileno(file), 1);
  dup2(fileno(file), 2);
  work();
  std::fflush(nullptr);
  std::cout.flush();
  dup2(out, 1);
  dup2(err, 2);
  close(out);
  close(err);
  std::string text(static_cast<std::size_t>(std::ftell(file)), ' ');
  std::rewind(file);
  text.resize(std::fread(text.data(), 1, text.size(), file));
  std::fclose(file);
  return text;
}

Errc code_of(const SemidefiniteProgram& program, const SdpOptions& options = {}) {
  try {
    solve(program, options);
  } catch (const Error& error) {
    return error.code();
  }
  FAIL("a broken program was solved");
  return Errc::internal;
}

}  // namespace

TEST_CASE("small programs have the answers they are known to have") {
  SUBCASE("the largest eigenvalue") {
    const SemidefiniteProgram program = largest_eigenvalue(Matrix{{2, 1}, {1, 2}});
    const SdpSolution s = solve(program);
    check_solved(program, s);
    CHECK(s.value == Approx(3).epsilon(1e-7));
    CHECK(s.bound == Approx(3).epsilon(1e-7));
    CHECK(s.dual_residual < 1e-8);
    CHECK(s.solver_status.substr(0, 2) == "pd");
  }
  SUBCASE("two variables, two inequalities, a constant") {
    // minimise x + y, [x 1; 1 y] ⪰ 0 and x ≥ 2: y = 1/2.
    const SemidefiniteProgram program{
        Vector::Ones(2),
        {{Matrix{{0, 1}, {1, 0}}, {{0, Matrix{{1, 0}, {0, 0}}}, {1, Matrix{{0, 0}, {0, 1}}}}},
         {scalar(-2), {{0, scalar(1)}}}}};
    const SdpSolution s = solve(program);
    check_solved(program, s);
    CHECK(s.x[0] == Approx(2).epsilon(1e-6));
    CHECK(s.x[1] == Approx(.5).epsilon(1e-6));
    CHECK(s.value == Approx(2.5).epsilon(1e-7));
  }
  SUBCASE("a linear program") {
    // minimise -x - 2 y, x + y ≤ 3, x ≥ 0, 0 ≤ y ≤ 2: (1, 2).
    const SemidefiniteProgram program{Vector{{-1, -2}},
                                      {{scalar(3), {{0, scalar(-1)}, {1, scalar(-1)}}},
                                       {scalar(0), {{0, scalar(1)}}},
                                       {scalar(0), {{1, scalar(1)}}},
                                       {scalar(2), {{1, scalar(-1)}}}}};
    const SdpSolution s = solve(program);
    check_solved(program, s);
    CHECK(s.value == Approx(-5).epsilon(1e-7));
    CHECK(s.x[0] == Approx(1).epsilon(1e-5));
  }
  SUBCASE("numbers of very different sizes") {
    const Matrix D{{1e3, 0, 0}, {0, 1, 0}, {0, 0, 1e-3}};
    // t D² - D A D ⪰ 0 is t I - A ⪰ 0; in units of 10⁴.
    const Matrix A{{2, 1, 0}, {1, 2, 1}, {0, 1, 2}};
    SemidefiniteProgram program{Vector::Ones(1), {{-(D * A * D), {{0, 1e4 * D * D}}}}};
    const SdpSolution s = solve(program);
    CHECK(s.status == SdpStatus::solved);
    CHECK(s.value == Approx((2 + std::sqrt(2)) * 1e-4).epsilon(1e-6));
  }
}

TEST_CASE(
    "a variable that nothing depends on is 0; one that lowers the cost without end is no "
    "solution") {
  SemidefiniteProgram program = largest_eigenvalue(Matrix{{2, 1}, {1, 2}});
  program.cost = Vector{{0, 1, 0}};
  program.inequalities[0].terms[0].first = 1;
  program.inequalities[0].terms.emplace_back(2, Matrix::Zero(2, 2));
  const SdpSolution s = solve(program);
  check_solved(program, s);
  CHECK(s.x[0] == 0);
  CHECK(s.x[2] == 0);
  CHECK(s.value == Approx(3).epsilon(1e-7));
  program.cost[0] = -1;
  const SdpSolution free = solve(program);
  CHECK(free.status == SdpStatus::unknown);
  CHECK_FALSE(free.why.empty());
  CHECK(solve({Vector::Ones(1), {{scalar(1), {}}}}).status == SdpStatus::unknown);
  CHECK(solve({Vector::Zero(1), {{scalar(1), {}}}}).status == SdpStatus::solved);
  for (const double cost : {0., 1.}) {
    const SemidefiniteProgram impossible{Vector{{cost}}, {{scalar(-1), {}}}};
    check_proof(impossible, solve(impossible), 1e8);
  }
}

TEST_CASE("variables that act alike are no obstacle") {
  SemidefiniteProgram program = largest_eigenvalue(Matrix{{2, 1}, {1, 2}});
  program.cost = Vector::Ones(2);
  program.inequalities[0].terms.emplace_back(1, Matrix::Identity(2, 2));
  const SdpSolution s = solve(program);
  check_solved(program, s);
  CHECK(s.value == Approx(3).epsilon(1e-6));
}

TEST_CASE("more variables than SDPA takes for few, each in a matrix of its own") {
  // |x_i - i| ≤ 1 and the least sum: x_i = i - 1. Its linear systems are diagonal.
  const Index m = 150;
  SemidefiniteProgram program{Vector::Ones(m), {}};
  for (Index i = 0; i < m; ++i) {
    const auto value = static_cast<double>(i);
    program.inequalities.push_back(
        {Matrix{{1, -value}, {-value, 1}}, {{i, Matrix{{0, 1}, {1, 0}}}}});
  }
  const SdpSolution s = solve(program);
  check_solved(program, s);
  CHECK(s.value == Approx(150. * 149 / 2 - 150).epsilon(1e-7));
}

TEST_CASE("an unbounded program is unknown") {
  const SemidefiniteProgram program{-Vector::Ones(1), {{scalar(0), {{0, scalar(1)}}}}};
  const SdpSolution s = solve(program);
  CHECK(s.status == SdpStatus::unknown);
  CHECK_FALSE(s.why.empty());
  CHECK(s.x.size() == 0);
  // The least value is not attained: x → ∞ in [x 1; 1 y] ⪰ 0, minimise y.
  const SemidefiniteProgram open{
      Vector{{0, 1}},
      {{Matrix{{0, 1}, {1, 0}}, {{0, Matrix{{1, 0}, {0, 0}}}, {1, Matrix{{0, 0}, {0, 1}}}}}}};
  const SdpSolution limit = solve(open);
  if (limit.status == SdpStatus::solved) CHECK(std::abs(limit.value) < 1e-3);
  CHECK(limit.status != SdpStatus::infeasible);
}

TEST_CASE("broken programs are errors") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  SemidefiniteProgram fine = largest_eigenvalue(Matrix{{2, 1}, {1, 2}});
  const auto with = [&](auto change) {
    SemidefiniteProgram program = fine;
    change(program);
    return code_of(program);
  };
  using P = SemidefiniteProgram;
  CHECK(with([](P& p) { p.cost.resize(0); }) == Errc::dimension);
  CHECK(with([](P& p) { p.inequalities.clear(); }) == Errc::dimension);
  CHECK(with([](P& p) { p.inequalities[0].constant.resize(0, 0); }) == Errc::dimension);
  CHECK(with([](P& p) { p.inequalities[0].constant = Matrix::Zero(2, 3); }) == Errc::dimension);
  CHECK(with([](P& p) { p.inequalities[0].terms[0].second = Matrix::Zero(3, 3); }) ==
        Errc::dimension);
  CHECK(with([](P& p) { p.inequalities[0].terms[0].first = 1; }) == Errc::dimension);
  CHECK(with([](P& p) { p.inequalities[0].terms[0].first = -1; }) == Errc::dimension);
  CHECK(with([](P& p) { p.inequalities[0].terms.push_back(p.inequalities[0].terms[0]); }) ==
        Errc::invalid);
  CHECK(with([](P& p) { p.inequalities[0].constant(0, 1) = 1.0000001; }) == Errc::invalid);
  CHECK(with([](P& p) { p.inequalities[0].terms[0].second(1, 0) = 1; }) == Errc::invalid);
  CHECK(with([&](P& p) { p.cost[0] = nan; }) == Errc::not_finite);
  CHECK(with([&](P& p) { p.inequalities[0].constant(1, 1) = nan; }) == Errc::not_finite);
  CHECK(with([&](P& p) { p.inequalities[0].terms[0].second(0, 0) = HUGE_VAL; }) ==
        Errc::not_finite);
  CHECK(code_of(fine, {0, 1e8, 200}) == Errc::invalid);
  CHECK(code_of(fine, {1e-9, nan, 200}) == Errc::invalid);
  CHECK(code_of(fine, {1e-9, 1e8, 0}) == Errc::invalid);
}

TEST_CASE("too few iterations are no answer") {
  const SdpSolution s = solve(largest_eigenvalue(Matrix{{2, 1}, {1, 2}}), {1e-9, 1e8, 2});
  CHECK(s.status == SdpStatus::unknown);
  CHECK_FALSE(s.why.empty());
}

TEST_CASE("the solver prints nothing, whatever it is given") {
  const std::string text = printed([] {
    solve(largest_eigenvalue(Matrix{{2, 1}, {1, 2}}));
    solve(contradiction());
    solve({-Vector::Ones(1), {{scalar(0), {{0, scalar(1)}}}}});
    SemidefiniteProgram alike = largest_eigenvalue(Matrix{{2, 1}, {1, 2}});
    alike.cost = Vector{{1, -1}};
    alike.inequalities[0].terms.emplace_back(1, Matrix::Identity(2, 2));
    solve(alike);
    solve({Vector::Ones(1),
           {{1e300 * Matrix::Identity(2, 2), {{0, -1e-300 * Matrix::Identity(2, 2)}}}}});
  });
  CHECK(text == "");
}

TEST_CASE("threads get the answers that one gets alone") {
  std::mt19937_64 engine(7);
  std::vector<SemidefiniteProgram> programs;
  std::vector<double> alone;
  for (int i = 0; i < 16; ++i) {
    programs.push_back(largest_eigenvalue(random_symmetric(4, engine)));
    alone.push_back(solve(programs.back()).value);
  }
  std::vector<double> together(programs.size());
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t i = t; i < programs.size(); i += 4) together[i] = solve(programs[i]).value;
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(together == alone);
}

TEST_CASE("random programs with analytic answers") {
  CHECK(rc::check("the largest eigenvalue", [](std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    const Index n = *rc::gen::inRange<Index>(1, 9);
    const double unit = std::pow(10., *rc::gen::inRange(-3, 4));
    const Matrix A = unit * random_symmetric(n, engine);
    const SemidefiniteProgram program = largest_eigenvalue(A);
    const SdpSolution s = solve(program);
    RC_ASSERT(s.status == SdpStatus::solved);
    const double exact = linalg::symmetric_eigen(A).values[n - 1];
    RC_ASSERT(std::abs(s.value - exact) <= 1e-6 * (1 + std::abs(exact)));
    RC_ASSERT(s.bound <= exact + 1e-6 * (1 + std::abs(exact)));
  }));
}

TEST_CASE(
    "random programs that are feasible by construction are solved, and their optimum is known") {
  CHECK(rc::check("F(x̂) and Y complement each other", [](std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const Index m = *rc::gen::inRange<Index>(1, 6);
    const Index blocks = *rc::gen::inRange<Index>(1, 4);
    // Optimality: F(x̂) = V diag(a, 0) Vᵀ and Y = V diag(0, b) Vᵀ, cost_i = Σ ⟨F_i, Y⟩; x̂ is then
    // optimal.
    SemidefiniteProgram program;
    program.cost = Vector::Zero(m);
    const Vector x = Vector::NullaryExpr(m, [&] { return uniform(engine); });
    for (Index j = 0; j < blocks; ++j) {
      const Index n = *rc::gen::inRange<Index>(2, 6);
      const Matrix V = linalg::symmetric_eigen(random_symmetric(n, engine)).vectors;
      const Index rank = *rc::gen::inRange<Index>(1, n);
      Vector a = Vector::Zero(n), b = Vector::Zero(n);
      a.head(rank).setConstant(1);
      b.tail(n - rank).setConstant(1);
      const Matrix Y = V * b.asDiagonal() * V.transpose();
      MatrixInequality F{V * a.asDiagonal() * V.transpose(), {}};
      for (Index i = 0; i < m; ++i) {
        const Matrix term = random_symmetric(n, engine);
        F.terms.emplace_back(i, term);
        F.constant -= x[i] * term;
        program.cost[i] += term.cwiseProduct(Y).sum();
      }
      F.constant = Matrix((F.constant + F.constant.transpose()) / 2);
      program.inequalities.push_back(F);
    }
    // A ball keeps both sides strictly feasible: the slack of its matrix is positive at x̂, so that
    // the optimum stays.
    Matrix ball = 10 * Matrix::Identity(m + 1, m + 1);
    MatrixInequality bound{ball, {}};
    for (Index i = 0; i < m; ++i) {
      Matrix term = Matrix::Zero(m + 1, m + 1);
      term(i, m) = term(m, i) = 1;
      bound.terms.emplace_back(i, term);
    }
    program.inequalities.push_back(bound);
    const SdpSolution s = solve(program, {1e-8});
    RC_ASSERT(s.status != SdpStatus::infeasible);
    if (s.status != SdpStatus::solved) RC_DISCARD("no answer");
    const double exact = program.cost.dot(x);
    RC_ASSERT(std::abs(s.value - exact) <= 1e-5 * (1 + std::abs(exact)));
    RC_ASSERT(s.bound <= exact + 1e-5 * (1 + std::abs(exact)));
  }));
}
