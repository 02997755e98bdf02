// SPDX-License-Identifier: GPL-3.0-or-later
// What the mixed-integer program is made of: enclosures of pairs, bounds of κ, the program of one
// pair, the search for a start.
#include <cmath>

#include <doctest/doctest.h>

#include "cordon/core/linalg.hpp"
#include "designers/milp/local_search.hpp"
#include "designers/milp/pair_reduction.hpp"
#include "input_design/milp_problems.hpp"

using namespace cordon;
using namespace cordon::designers;
using examples::numbers;
using examples::random_pair;
using examples::random_vector;

namespace {

Index draw(std::mt19937& random, Index least, Index most) {
  return std::uniform_int_distribution<Index>(least, most)(random);
}

InputSequences box(Index n, double range) {
  return {Vector::Zero(n), range * Matrix::Identity(n, n), Matrix(0, n), Vector(0)};
}

SeparationProblem problem_of(const PairProgram& pair, Cost::Kind kind, std::mt19937& random) {
  SeparationProblem problem;
  const Index n = pair.N.cols();
  problem.inputs = n;
  problem.pairs = {pair};
  problem.U = box(n, 4);
  problem.cost = {kind, random_vector(random, n, 1).cwiseAbs() + Vector::Constant(n, .2),
                  random_vector(random, n, 1)};
  problem.epsilon = 1e-3;
  return problem;
}

}  // namespace

TEST_CASE("A reduced pair is nowhere farther apart than the pair") {
  std::mt19937 random(1);
  double closest = infinity;
  for (int trial = 0; trial < 60; ++trial) {
    const Index m = draw(random, 1, 6), inputs = draw(random, 1, 5),
                rank = draw(random, 1, std::min(m, inputs));
    const PairProgram pair = random_pair(random, m, draw(random, m, 16), inputs, rank);
    InputSequences U = box(inputs, 5);
    if (trial % 3 == 0 && inputs > rank) {  // a row: what differs of u lies in a plane
      U.A = random_vector(random, inputs, 1).transpose();
      U.b = Vector::Constant(1, .2);
    }
    const Index generators = draw(random, rank, 10), constraints = draw(random, 0, 3);
    const auto reduced = reduce_pair(pair, U, generators, constraints);
    REQUIRE(reduced);
    CHECK(reduced->G.cols() <= generators);
    CHECK(reduced->rows() <= rank + constraints);
    for (int k = 0; k < 20; ++k) {
      Vector xi = random_vector(random, inputs, 1);
      if (U.b.size() > 0) xi += linalg::pseudo_inverse(U.A) * (U.b - U.A * xi);
      const Vector u = U.c + U.G * xi;
      const double kappa = separation(pair, u).kappa, less = separation(*reduced, u).kappa;
      CHECK(less <= kappa + 1e-7 * (1 + std::abs(kappa)));
      if (kappa > 0) closest = std::min(closest, kappa - less);
    }
  }
  CHECK(closest < 1e-6);  // some lose nothing
}

TEST_CASE("With room for everything nothing is lost") {
  std::mt19937 random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const Index m = draw(random, 1, 5), inputs = draw(random, 1, 4),
                rank = draw(random, 1, std::min(m, inputs));
    const Index g = draw(random, m + 2, 10);
    const PairProgram pair = random_pair(random, m, g, inputs, rank);
    const auto reduced = reduce_pair(pair, box(inputs, 5), g + 5, m);
    REQUIRE(reduced);
    for (int k = 0; k < 10; ++k) {
      const Vector u = random_vector(random, inputs, 5);
      const double kappa = separation(pair, u).kappa;
      CHECK(separation(*reduced, u).kappa == doctest::Approx(kappa).epsilon(1e-6));
    }
  }
}

TEST_CASE("Generators that are parallel are one") {
  PairProgram pair{0, 1, Matrix(2, 6), numbers({0, 0}), Matrix::Identity(2, 2), numbers({0, 0})};
  pair.G << 1, 2, -3, 0, 0, .5, 0, 0, 0, 1, -4, .5;
  const auto reduced = reduce_pair(pair, box(2, 9), 3, 0);
  REQUIRE(reduced);
  CHECK(reduced->G.cols() == 3);
  for (const Vector& u : {numbers({9, 1}), numbers({-2, 8}), numbers({8, -7})}) {
    CHECK(separation(*reduced, u).kappa == doctest::Approx(separation(pair, u).kappa));
  }
}

TEST_CASE("Where nothing disturbs, κ is finite but large") {
  const PairProgram pair{0,
                         1,
                         (Matrix(2, 2) << 1, 0, 0, 0).finished(),
                         numbers({0, 0}),
                         Matrix::Identity(2, 2),
                         numbers({0, 0})};
  const auto reduced = reduce_pair(pair, box(2, 4), 4, 0);
  REQUIRE(reduced);
  CHECK(separation(pair, numbers({0, 1})).kappa == infinity);
  const double kappa = separation(*reduced, numbers({0, 1})).kappa;
  CHECK(kappa > 50);
  CHECK(kappa < 1e6);
  CHECK(separation(*reduced, numbers({3, 0})).kappa == doctest::Approx(2));
  const PairProgram nothing{0, 1, Matrix(1, 0), numbers({0}), Matrix::Ones(1, 1), numbers({0})};
  const auto padded = reduce_pair(nothing, box(1, 4), 2, 0);
  REQUIRE(padded);
  CHECK(separation(*padded, numbers({1})).kappa > 50);
}

TEST_CASE("Pairs that cannot be reduced are told from others") {
  std::mt19937 random(3);
  const PairProgram pair = random_pair(random, 4, 8, 5, 3);
  CHECK_FALSE(reduce_pair(pair, box(5, 1), 2, 2));
  CHECK(reduce_pair(pair, box(5, 1), 3, 2));
  CHECK(inputs_enter(pair, box(5, 1)));
  CHECK_FALSE(inputs_enter(
      pair, {Vector::Ones(5), Matrix::Zero(5, 5), Matrix(0, 5), Vector(0)}));  // U is a point
  InputSequences fixed = box(5, 1);
  fixed.A = Matrix::Identity(5, 5);  // as is this
  fixed.b = Vector::Constant(5, .5);
  CHECK_FALSE(inputs_enter(pair, fixed));
  CHECK_FALSE(reduce_pair(pair, fixed, 8, 2));
}

TEST_CASE("The gauge is κ + 1, with a normal and a point that attain it") {
  std::mt19937 random(4);
  for (int trial = 0; trial < 30; ++trial) {
    const Index m = draw(random, 1, 4);
    const PairProgram pair = random_pair(random, m, draw(random, m, 9), 3, 1);
    const Vector u = random_vector(random, 3, 3), z = pair.N * u - pair.c;
    const auto apart = Gauge(pair.G).at(z);
    REQUIRE(apart);
    CHECK(apart->value == doctest::Approx(separation(pair, u).kappa + 1));
    CHECK(apart->lambda.dot(z) == doctest::Approx(apart->value));
    CHECK((pair.G.transpose() * apart->lambda).lpNorm<1>() <= 1 + 1e-9);
  }
}

TEST_CASE("No input that costs no more has a larger κ than the bound") {
  std::mt19937 random(5);
  for (int trial = 0; trial < 36; ++trial) {
    const Index m = draw(random, 1, 3), inputs = trial % 4 == 3 ? 12 : draw(random, 1, 4);
    const PairProgram pair =
        random_pair(random, m, draw(random, m, 8), inputs, std::min(m, inputs));
    const SeparationProblem problem =
        problem_of(pair,
                   std::array{Cost::Kind::norm_1, Cost::Kind::norm_inf,
                              Cost::Kind::quadratic}[static_cast<std::size_t>(trial % 3)],
                   random);
    LocalSearch local(problem, problem.pairs, [] { return 60.0; });
    InputProgram limited(problem);
    const double cost = trial % 2 == 0 ? 1 : 10;
    limited.limit_cost(cost);
    const double free = local.largest_kappa(0, Vector::Constant(inputs, -4),
                                            Vector::Constant(inputs, 4), infinity),
                 most = local.largest_kappa(0, limited.lower(), limited.upper(), cost);
    CHECK(most <= free + 1e-6);
    double largest = -1;
    for (int k = 0; k < 200; ++k) {
      // on the sphere of the cost, or as far as the box goes
      Vector u = problem.cost.reference + random_vector(random, inputs, 1).unaryExpr([&](double x) {
        return k % 2 == 0 ? x : std::pow(x, 9);
      });
      const double there = problem.cost.at(u);
      if (there == 0) continue;
      const double factor =
          problem.cost.kind == Cost::Kind::quadratic ? std::sqrt(cost / there) : cost / there;
      u = (problem.cost.reference + factor * (u - problem.cost.reference)).cwiseMax(-4).cwiseMin(4);
      if (problem.cost.at(u) > cost * (1 + 1e-9))
        continue;  // the reference is inside of the box, so that this never happens
      CHECK((u - limited.lower()).minCoeff() >= -1e-9);
      CHECK((limited.upper() - u).minCoeff() >= -1e-9);
      const double kappa = separation(pair, u).kappa;
      largest = std::max(largest, kappa);
      CHECK(kappa <= most);
    }
    CHECK(largest > -1);
    if (inputs > 4) continue;
    double corner = -1;  // without a cost and with few inputs the bound is the maximum
    for (int vertex = 0; vertex < 1 << inputs; ++vertex) {
      Vector u(inputs);
      for (Index i = 0; i < inputs; ++i) u[i] = (vertex >> i) & 1 ? 4 : -4;
      corner = std::max(corner, separation(pair, u).kappa);
    }
    CHECK(free == doctest::Approx(corner).epsilon(1e-5));
  }
}

TEST_CASE("The program of a pair admits an input if and only if κ is in its range") {
  std::mt19937 random(6);
  int apart = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Index m = draw(random, 1, 3);
    const PairProgram pair = random_pair(random, m, draw(random, m, 6), 2, std::min<Index>(m, 2));
    SeparationProblem problem = problem_of(pair, Cost::Kind::norm_1, random);
    const Vector u = random_vector(random, 2, 4);
    const double kappa = separation(pair, u).kappa;
    if (kappa < .02) continue;
    ++apart;
    problem.U = {u, Matrix::Zero(2, 1), Matrix(0, 1), Vector(0)};
    const auto status = [&](double least, double most) {
      InputProgram program(problem);
      add_pair(program, pair, least, most);
      return solve(program.program()).status;
    };
    CHECK(status(kappa - .01, kappa + .5) == MipStatus::optimal);
    CHECK(status(0, kappa + .01) == MipStatus::optimal);
    CHECK(status(kappa + .01, 2 * kappa + 1) == MipStatus::infeasible);
    CHECK(status(0, kappa - .01) == MipStatus::infeasible);
  }
  CHECK(apart > 10);
}

TEST_CASE("The local search separates as asked, and gets cheaper") {
  std::mt19937 random(7);
  for (const auto kind : {Cost::Kind::norm_1, Cost::Kind::norm_inf, Cost::Kind::quadratic}) {
    int found = 0;
    for (int trial = 0; trial < 10; ++trial) {
      const SeparationProblem problem = problem_of(random_pair(random, 2, 5, 3, 2), kind, random);
      LocalSearch local(problem, problem.pairs, [] { return 60.0; });
      const Vector begin = random_vector(random, 3, 4);
      const double kappa = separation(problem.pairs[0], begin).kappa;
      const auto u = local.from(begin);
      if (!u) continue;
      ++found;
      CHECK(separation(problem.pairs[0], *u).kappa >= problem.epsilon - 1e-7);
      CHECK(u->cwiseAbs().maxCoeff() <= 4 + 1e-9);
      if (kappa > problem.epsilon) CHECK(problem.cost.at(*u) <= problem.cost.at(begin) + 1e-9);
    }
    CHECK(found > 5);
  }
  const SeparationProblem problem =
      problem_of(random_pair(random, 2, 5, 3, 2), Cost::Kind::norm_1, random);
  CHECK_FALSE(LocalSearch(problem, problem.pairs, [] { return 0.0; }).from(numbers({4, 4, 4})));
}

TEST_CASE("A quadratic cost is met by tangents from below") {
  std::mt19937 random(8);
  const SeparationProblem problem =
      problem_of(random_pair(random, 1, 2, 2, 1), Cost::Kind::quadratic, random);
  for (int trial = 0; trial < 10; ++trial) {
    const Vector u = random_vector(random, 2, 4);
    SeparationProblem fixed = problem;
    fixed.U = {u, Matrix::Zero(2, 1), Matrix(0, 1), Vector(0)};
    InputProgram program(fixed);
    CHECK(solve(program.program()).objective == doctest::Approx(0));
    program.add_tangents(random_vector(random, 2, 4));
    program.add_tangents(problem.cost.reference);
    CHECK(solve(program.program()).objective <= problem.cost.at(u) + 1e-9);
    program.add_tangents(u);
    CHECK(solve(program.program()).objective == doctest::Approx(problem.cost.at(u)));
    program.demand_cost(problem.cost.at(u) + 1);
    CHECK(solve(program.program()).objective == doctest::Approx(problem.cost.at(u) + 1));
  }
}
