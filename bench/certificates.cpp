// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates beside the linear programs they certify. The time is that of program and check
// together; the counters are the medians of both in microseconds, and the check's share of its
// program. A check has bounded rounding errors or is rational.
#include <chrono>

#include "cordon/core/rounding.hpp"
#include "cordon/solvers/boxed_program.hpp"
#include "cordon/solvers/certificate.hpp"
#include "cordon/solvers/lp.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "random_sets.hpp"

namespace {

using namespace cordon;
using namespace cordon::bench;
using Clock = std::chrono::steady_clock;
using Kind = Certificate::Kind;

constexpr std::uint64_t sets_asked = 8;  ///< of emptiness: as many sets take turns

double microseconds(Clock::duration time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

/// Each iteration solves one program and checks what it proposes; `check` tells whether the
/// proposal proves the answer.
template <class Propose, class Check>
void certified(benchmark::State& state, Propose propose, Check check) {
  double program = 0, checked = 0;
  std::size_t i = 0;
  for (auto _ : state) {
    const auto begin = Clock::now();
    const auto proposal = propose(i);
    const auto solved = Clock::now();
    const bool proven = check(i, proposal);
    const auto end = Clock::now();
    if (!proven) state.SkipWithError("the check must succeed on these instances");
    program += microseconds(solved - begin);
    checked += microseconds(end - solved);
    state.SetIterationTime(microseconds(end - begin) * 1e-6);
    ++i;
  }
  const double count = static_cast<double>(i);
  state.counters["program"] = program / count;
  state.counters["check"] = checked / count;
  state.counters["share"] = checked / program;
}

/// The bounds of a hull: one program per set, whose basis is kept from direction to direction.
template <class Check>
void bound(benchmark::State& state, Check check) {
  const LineForm X = random_set(size(state));
  const Vector one = Vector::Ones(X.generators());
  LinearProgram program(X.A, X.b, -one, one);
  std::vector<Vector> directions, objectives;
  for (Index j = 0; j < 2 * X.dim(); ++j) {
    directions.emplace_back(Vector::Unit(X.dim(), j / 2) * (j % 2 == 0 ? 1.0 : -1.0));
    objectives.emplace_back(X.G.transpose() * directions.back());
  }
  const auto turn = [&](std::size_t i) { return i % directions.size(); };
  certified(
      state, [&](std::size_t i) { return program.maximize(objectives[turn(i)]); },
      [&](std::size_t i, const LinearProgram::Solution& solution) {
        return check(X, directions[turn(i)], objectives[turn(i)], solution);
      });
}

void bound_certificate(benchmark::State& state) {
  bound(state, [](const LineForm& X, const Vector&, const Vector& g,
                  const LinearProgram::Solution& solution) {
    const double upper = rounding::up(rounding::dot(X.b, solution.y).upper +
                                      rounding::residual_norm_1(g, X.A, solution.y));
    return upper >= solution.objective - 1e-9 && upper <= solution.objective + 1e-9;
  });
}
void bound_rational(benchmark::State& state) {
  bound(state, [](const LineForm& X, const Vector& d, const Vector&,
                  const LinearProgram::Solution& solution) {
    const double upper = d.dot(X.c) + solution.objective + 1e-9;
    return proves_support(X, d, upper, {Kind::dual, solution.y, upper});
  });
}

/// max τ with Aξ = τ b, ‖ξ‖∞ ≤ 1, 0 ≤ τ ≤ 2: from the beginning for each set, as emptiness is asked
/// once.
LinearProgram::Solution scaled_solution(const LineForm& X) {
  const Index g = X.generators();
  Matrix rows(X.constraints(), g + 1);
  rows << X.A, -X.b;
  Vector lower = Vector::Constant(g + 1, -1), upper = Vector::Ones(g + 1);
  lower[g] = 0;
  upper[g] = 2;
  return LinearProgram(rows, Vector::Zero(X.constraints()), lower, upper)
      .maximize(Vector::Unit(g + 1, g));
}

template <class Check>
void emptiness(benchmark::State& state, bool empty, Check check) {
  std::vector<LineForm> sets;
  for (std::uint64_t seed = 1; seed <= sets_asked; ++seed) {
    LineForm X = random_set(size(state), seed);
    for (int tries = 0; empty && tries < 20 && is_empty(X) != Answer::yes; ++tries) X.b *= 2;
    if (is_empty(X) == (empty ? Answer::yes : Answer::no)) sets.push_back(std::move(X));
  }
  if (sets.empty()) return state.SkipWithError("no set has the answer that is measured");
  certified(
      state, [&](std::size_t i) { return scaled_solution(sets[i % sets.size()]); },
      [&](std::size_t i, const LinearProgram::Solution& solution) {
        return check(sets[i % sets.size()], solution);
      });
}

Vector point_of(const LinearProgram::Solution& solution) {
  return solution.x.head(solution.x.size() - 1) / solution.objective;
}

void empty_certificate(benchmark::State& state) {
  emptiness(state, true, [](const LineForm& X, const LinearProgram::Solution& s) {
    return farkas_margin(X.A, X.b, -s.y) > 0;
  });
}
void empty_rational(benchmark::State& state) {
  emptiness(state, true, [](const LineForm& X, const LinearProgram::Solution& s) {
    return proves_empty(X, {Kind::farkas, -s.y, 0});
  });
}
void point_certificate(benchmark::State& state) {
  emptiness(state, false, [](const LineForm& X, const LinearProgram::Solution& s) {
    const Vector xi = point_of(s);
    const auto radius = repair_radius(X.A, X.b, xi);
    return radius && (xi.cwiseAbs() + *radius).maxCoeff() <= 1;
  });
}
void point_rational(benchmark::State& state) {
  emptiness(state, false, [](const LineForm& X, const LinearProgram::Solution& s) {
    return proves_not_empty(X, {Kind::point, point_of(s), 0});
  });
}

void paired(benchmark::internal::Benchmark* b) {
  sizes(b);
  b->UseManualTime();
}
/// Without the largest size, which takes seconds: a point is moved onto its rows by solving them.
void paired_small(benchmark::internal::Benchmark* b) {
  b->Args({3, 30, 5})
      ->Args({10, 100, 20})
      ->Repetitions(7)
      ->Unit(benchmark::kMicrosecond)
      ->MinTime(.05)
      ->UseManualTime();
}

BENCHMARK(bound_certificate)->Apply(paired);
BENCHMARK(bound_rational)->Apply(paired);
BENCHMARK(empty_certificate)->Apply(paired);
BENCHMARK(empty_rational)->Apply(paired);
BENCHMARK(point_certificate)->Apply(paired);
BENCHMARK(point_rational)->Apply(paired_small);

}  // namespace
