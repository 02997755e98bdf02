// SPDX-License-Identifier: GPL-3.0-or-later
// Mixed-integer programs with known answers, broken ones, and ends before the end.
#include "cordon/solvers/mip.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <thread>
#include <utility>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "cordon/core/error.hpp"
#include "cordon/solvers/lp.hpp"

using namespace cordon;
using doctest::Approx;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

MixedIntegerProgram program(const Matrix& A, const Vector& row_lower, const Vector& row_upper,
                            const Vector& cost, const Vector& lower, const Vector& upper,
                            std::vector<bool> integer) {
  MixedIntegerProgram p{{cost, {}, row_lower, row_upper, lower, upper}, std::move(integer)};
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = 0; j < A.cols(); ++j) p.entries.push_back({i, j, A(i, j)});
  }
  return p;
}

Vector all(Index n, double value) { return Vector::Constant(n, value); }

/// Worth and weight of things, of which the most worth is chosen that weighs at most `capacity`:
/// minimise -worth.
struct Knapsack {
  Matrix weight;  ///< a row per limit
  Vector worth, capacity;

  MixedIntegerProgram as_program() const {
    const Index n = worth.size();
    return program(weight, all(capacity.size(), -infinity), capacity, -worth, all(n, 0), all(n, 1),
                   std::vector<bool>(static_cast<std::size_t>(n), true));
  }
  double by_enumeration() const {
    double best = 0;
    for (int chosen = 0; chosen < 1 << worth.size(); ++chosen) {
      Vector x(worth.size());
      for (Index j = 0; j < x.size(); ++j) x[j] = (chosen >> j) & 1;
      if ((weight * x - capacity).maxCoeff() <= 1e-12) best = std::max(best, worth.dot(x));
    }
    return best;
  }
};

Knapsack knapsack(Index things, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::uniform_int_distribution<int> number(1, 60);
  Knapsack k;
  k.weight = Matrix::NullaryExpr(2, things, [&] { return number(engine); });
  k.worth = Vector::NullaryExpr(things, [&] { return number(engine); });
  k.capacity = k.weight.rowwise().sum() * .45;
  return k;
}

/// Takes long: things are to be split so that both halves weigh the same on four scales, as nearly
/// as may be.
MixedIntegerProgram long_program() {
  const Index n = 30, m = 4;
  std::mt19937_64 engine(7);
  std::uniform_int_distribution<int> number(0, 99);
  Matrix A(m, n + 2 * m);
  A << Matrix::NullaryExpr(m, n, [&] { return number(engine); }), Matrix::Identity(m, m),
      -Matrix::Identity(m, m);
  const Vector half = A.leftCols(n).rowwise().sum().array().unaryExpr(
      [](double sum) { return std::floor(sum / 2); });
  Vector cost = Vector::Zero(n + 2 * m), upper = Vector::Ones(n + 2 * m);
  cost.tail(2 * m).setOnes();
  upper.tail(2 * m).setConstant(infinity);
  std::vector<bool> integer(static_cast<std::size_t>(n + 2 * m), false);
  std::fill(integer.begin(), integer.begin() + n, true);
  return program(A, half, half, cost, all(n + 2 * m, 0), upper, integer);
}

}  // namespace

TEST_CASE("whole numbers and others together") {
  // minimise -x - 2y, x + y ≤ 3.5, y ≤ 2.6 + .1 x, x whole: x = 1: y = 2.5 → -6; x = 0: y = 2.6 →
  // -5.2; x = 2: y = 1.5 → -5.
  const MixedIntegerProgram p =
      program((Matrix(2, 2) << 1, 1, -.1, 1).finished(), all(2, -infinity),
              (Vector(2) << 3.5, 2.6).finished(), (Vector(2) << -1, -2).finished(), all(2, 0),
              all(2, 10), {true, false});
  const MipSolution solution = solve(p);
  REQUIRE(solution.status == MipStatus::optimal);
  CHECK(solution.objective == Approx(-6));
  CHECK(solution.x[0] == 1);
  CHECK(solution.x[1] == Approx(2.5));
  CHECK(solution.bound == Approx(-6));
}

TEST_CASE("rows with two bounds, equations, and free columns") {
  // minimise z subject to z ≥ 2 - x, z ≥ x - 2, 3 ≤ 2x ≤ 7 with x = 2 w, w whole: w = 1, z = 0.
  const double inf = infinity;
  const MixedIntegerProgram p =
      program((Matrix(4, 3) << 1, 0, 1, -1, 0, 1, 2, 0, 0, 1, -2, 0).finished(),
              (Vector(4) << 2, -2, 3, 0).finished(), (Vector(4) << inf, inf, 7, 0).finished(),
              (Vector(3) << 0, 0, 1).finished(), (Vector(3) << -inf, -5, -inf).finished(),
              (Vector(3) << inf, 5, inf).finished(), {false, true, false});
  const MipSolution solution = solve(p);
  REQUIRE(solution.status == MipStatus::optimal);
  CHECK(solution.x[0] == Approx(2));
  CHECK(solution.x[1] == 1);
  CHECK(std::abs(solution.objective) < 1e-9);
}

TEST_CASE("programs without a solution are infeasible, with a relaxation or without") {
  // 2x = 1 has a relaxed solution, no whole one.
  MixedIntegerProgram p =
      program(all(1, 2), all(1, 1), all(1, 1), all(1, 1), all(1, 0), all(1, 1), {true});
  CHECK(solve(p).status == MipStatus::infeasible);
  CHECK(solve(p).bound == infinity);
  p.row_lower = p.row_upper = all(1, 5);
  CHECK(solve(p).status == MipStatus::infeasible);
  p.integer = {false};
  CHECK(solve(p).status == MipStatus::infeasible);
}

TEST_CASE("an unbounded program gives no claim") {
  const MixedIntegerProgram p = program(all(1, 1), all(1, 0), all(1, infinity), all(1, -1),
                                        all(1, 0), all(1, infinity), {false});
  const MipSolution solution = solve(p);
  CHECK(solution.status == MipStatus::failed);
  CHECK(solution.x.size() == 0);
}

TEST_CASE("random knapsacks agree with enumeration") {
  CHECK(rc::check("knapsacks", [] {
    const Knapsack k =
        knapsack(*rc::gen::inRange<Index>(1, 13), *rc::gen::arbitrary<std::uint64_t>());
    const MipSolution solution = solve(k.as_program());
    RC_ASSERT(solution.status == MipStatus::optimal);
    RC_ASSERT(std::abs(solution.objective + k.by_enumeration()) < 1e-6);
    RC_ASSERT(std::abs(solution.bound - solution.objective) <=
              1e-6 * (1 + std::abs(solution.objective)));
    RC_ASSERT((k.weight * solution.x - k.capacity).maxCoeff() <= 1e-6);
    RC_ASSERT((solution.x.array() == solution.x.array().round()).all());
    MipOptions options;
    options.cuts = false;
    for (Index j = k.worth.size() - 1; j >= 0; j -= 2) options.branching.push_back(j);
    RC_ASSERT(std::abs(solve(k.as_program(), options).objective - solution.objective) < 1e-6);
  }));
}

TEST_CASE("a time limit ends the search with a bound that holds") {
  MipOptions options;
  options.gap = 0;
  options.time_limit = .05;
  const MipSolution early = solve(long_program(), options);
  CHECK((early.status == MipStatus::feasible || early.status == MipStatus::limit));
  options.time_limit = 0;
  const MipSolution never = solve(long_program(), options);
  CHECK(never.status == MipStatus::limit);
  CHECK(never.bound == -infinity);
  CHECK(never.nodes == 0);
}

TEST_CASE("the search can be watched and ended, by an exception too") {
  MipOptions options;
  options.gap = 0;
  int calls = 0;
  double last_best = infinity, last_bound = -infinity;
  options.watch = [&](double best, double bound) {
    CHECK(best <= last_best);
    CHECK(bound >= last_bound);
    CHECK(bound <= best);
    last_best = best;
    last_bound = bound;
    return ++calls == 200;
  };
  const MipSolution solution = solve(long_program(), options);
  CHECK(calls == 200);
  CHECK((solution.status == MipStatus::feasible || solution.status == MipStatus::limit));
  CHECK(solution.bound == last_bound);
  CHECK(std::isfinite(solution.bound));
  CHECK(solution.nodes > 1);
  options.watch = [](double, double) -> bool { throw std::runtime_error("enough"); };
  CHECK_THROWS_WITH(solve(long_program(), options), "enough");
  // and the solver is as good as before
  const Knapsack k = knapsack(8, 3);
  CHECK(solve(k.as_program()).objective == Approx(-k.by_enumeration()));
}

TEST_CASE("a start is used where it is a solution") {
  const Knapsack k = knapsack(12, 5);
  MipOptions options;
  const MipSolution best = solve(k.as_program());
  REQUIRE(best.status == MipStatus::optimal);
  double seen = 0;
  bool first = true;
  options.watch = [&](double value, double) {
    if (std::isfinite(value) && std::exchange(first, false)) seen = value;
    return false;
  };
  options.start = best.x;
  CHECK(solve(k.as_program(), options).objective == Approx(best.objective));
  CHECK(seen == Approx(best.objective));
  // Nothing else is tried: the start is the answer.
  options.time_limit = 0;
  MipSolution given = solve(k.as_program(), options);
  CHECK(given.status == MipStatus::feasible);
  CHECK(given.objective == Approx(best.objective));
  CHECK(given.bound == -infinity);
  for (const double wrong :
       {2.0, -1.0, 1.0 / 3, not_a_number}) {  // outside its bounds, not whole, no number
    options.start = best.x;
    (*options.start)[0] = wrong;
    CHECK(solve(k.as_program(), options).status == MipStatus::limit);
  }
  options.start = all(12, 1);  // too heavy
  CHECK(solve(k.as_program(), options).status == MipStatus::limit);
}

TEST_CASE("the search begins with its start") {
  const MixedIntegerProgram p = long_program();
  MipOptions options;
  Vector start = Vector::Zero(p.cost.size());  // nothing on one side: the slack is all
  start.segment(30, 4) = p.row_lower;
  options.start.emplace(std::move(start));
  double first = infinity;
  options.watch = [&](double best, double) {
    first = std::min(first, best);
    return best < infinity;
  };
  const MipSolution solution = solve(p, options);
  CHECK(solution.status == MipStatus::feasible);
  CHECK(first == Approx(p.row_lower.sum()));
  CHECK(solution.objective == Approx(p.row_lower.sum()));
}

TEST_CASE("the gap ends the search") {
  const MixedIntegerProgram p = knapsack(40, 2).as_program();
  MipOptions options;
  options.cuts = false;
  options.gap = 0;
  const MipSolution exact = solve(p, options);
  options.gap = .05;
  const MipSolution near = solve(p, options);
  CHECK(near.status == MipStatus::optimal);
  CHECK(near.nodes < exact.nodes);
  CHECK(near.bound <= exact.objective + 1e-9);
  CHECK(near.objective - near.bound <= .06 * std::abs(near.objective));
}

namespace {

bool refused(const MixedIntegerProgram& p, Errc code, const MipOptions& options = {}) {
  try {
    solve(p, options);
  } catch (const Error& error) {
    return error.code() == code;
  }
  return false;
}

}  // namespace

TEST_CASE("broken programs are refused") {
  const MixedIntegerProgram good = knapsack(3, 1).as_program();
  MixedIntegerProgram p;
  CHECK(refused(p, Errc::dimension));
  p = good;
  p.cost[1] = not_a_number;
  CHECK(refused(p, Errc::not_finite));
  p = good;
  p.entries[0].value = infinity;
  CHECK(refused(p, Errc::not_finite));
  p = good;
  p.lower[0] = 2;
  CHECK(refused(p, Errc::not_finite));
  p = good;
  p.row_upper[0] = not_a_number;
  CHECK(refused(p, Errc::not_finite));
  p = good;
  p.row_lower[0] = p.row_upper[0] = infinity;
  CHECK(refused(p, Errc::not_finite));
  p = good;
  p.entries[0].col = 3;
  CHECK(refused(p, Errc::dimension));
  p = good;
  p.entries[0].row = -1;
  CHECK(refused(p, Errc::dimension));
  p = good;
  p.entries.push_back(p.entries[0]);
  CHECK(refused(p, Errc::invalid));
  p = good;
  p.upper[0] = 1.5;
  CHECK(refused(p, Errc::invalid));
  p = good;
  p.upper[0] = infinity;
  CHECK(refused(p, Errc::invalid));
  p = good;
  p.integer.pop_back();
  CHECK(refused(p, Errc::dimension));
}

TEST_CASE("broken options are refused") {
  const MixedIntegerProgram good = knapsack(3, 1).as_program();
  MipOptions options;
  options.start = all(2, 0);
  CHECK(refused(good, Errc::dimension, options));
  options = {};
  options.time_limit = not_a_number;
  CHECK(refused(good, Errc::invalid, options));
  options = {};
  options.branching = {0, 3};
  CHECK(refused(good, Errc::invalid, options));
  options.branching = {-1};
  CHECK(refused(good, Errc::invalid, options));
  MixedIntegerProgram p = good;
  p.integer[0] = false;
  options.branching = {0};
  CHECK(refused(p, Errc::invalid, options));
  options = {};
  options.gap = -1;
  CHECK(refused(good, Errc::invalid, options));
}

TEST_CASE("every thread solves for itself, beside linear programs") {
  const Knapsack k = knapsack(10, 11);
  const double best = -k.by_enumeration();
  LinearProgram linear(Matrix::Ones(1, 2), Vector::Ones(1), Vector::Zero(2), Vector::Ones(2));
  double found[2] = {0, 0};
  std::thread other([&] { found[0] = solve(k.as_program()).objective; });
  found[1] = solve(k.as_program()).objective;
  other.join();
  CHECK(found[0] == Approx(best));
  CHECK(found[1] == Approx(best));
  CHECK(linear.maximize((Vector(2) << 1, 2).finished()).objective == Approx(2));
}
