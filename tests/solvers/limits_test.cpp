// SPDX-License-Identifier: GPL-3.0-or-later
// What solvers leave open beyond their limits, and that nothing of it is wrong.
#include "cordon/solvers/limits.hpp"

#include <thread>

#include <doctest/doctest.h>

#include "cordon/sets/sampling.hpp"
#include "cordon/solvers/set_questions.hpp"

using namespace cordon;

namespace {

using Clock = SolverLimits::Clock;

SolverLimits programs(std::int64_t most) { return {{}, most}; }

/// Three states: not empty.
LineForm constrained(std::uint64_t seed, Index rows = 4, Index generators = 12) {
  sets::Random random(seed);
  LineForm X;
  X.c = random.cube(3);
  X.M = Matrix(3, 0), X.S = Matrix(rows, 0);
  X.G = Matrix(3, generators), X.A = Matrix(rows, generators);
  for (Index j = 0; j < generators; ++j)
    X.G.col(j) = random.cube(3), X.A.col(j) = random.cube(rows);
  X.b = X.A * (0.5 * random.cube(generators));
  return X;
}

}  // namespace

TEST_CASE("bounds beyond the number of programs are wider, and say so") {
  int wider = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const LineForm X = constrained(seed);
    const Box free = interval_hull(X);
    for (const std::int64_t most : {6, 4, 2, 0}) {
      LimitedSolvers solvers(programs(most));
      const Box limited = interval_hull(X);
      CHECK((limited.lower.array() <= free.lower.array() + 1e-12).all());
      CHECK((limited.upper.array() >= free.upper.array() - 1e-12).all());
      const bool is_wider =
          (limited.upper - limited.lower).sum() > (free.upper - free.lower).sum() + 1e-9;
      if (is_wider) CHECK(solvers.left_open());
      wider += most == 0 && is_wider;
    }
    CHECK(interval_hull(X).lower == free.lower);  // without limits as before
  }
  CHECK(wider > 40);
}

TEST_CASE("emptiness beyond the limit is open, and never wrong") {
  int open = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    LineForm X = constrained(seed, 20, 26);
    sets::Random random(seed);  // near a corner of the factors, where least squares tell nothing
    const Vector corner =
        X.A * random.cube(26).unaryExpr([](double x) { return x < 0 ? -1. : 1.; });
    for (const double scale : {.9, .97, 1., 1.03}) {
      X.b = scale * corner;
      const Answer known = is_empty(X);
      const LimitedSolvers solvers(programs(0));
      const Answer answer = is_empty(X);
      CHECK((answer == known || answer == Answer::unknown));
      open += answer == Answer::unknown;
      if (answer == Answer::unknown) CHECK(solvers.left_open());
    }
  }
  CHECK(open > 0);
}

TEST_CASE("the innermost number of programs counts, and the first deadline") {
  CHECK(LimitedSolvers::may_begin());
  CHECK(!LimitedSolvers::of_this_thread().programs);
  {
    LimitedSolvers outer(programs(2));
    CHECK(LimitedSolvers::may_begin());
    {
      LimitedSolvers inner(programs(1));
      CHECK(LimitedSolvers::of_this_thread().programs == 1);
      CHECK(LimitedSolvers::may_begin());
      CHECK(!LimitedSolvers::may_begin());
      CHECK(inner.left_open());
      LimitedSolvers deadline({Clock::now() + std::chrono::hours(1), {}});
      CHECK(!LimitedSolvers::may_begin());
      CHECK(!LimitedSolvers::is_over());
    }
    CHECK(outer.left_open());
    CHECK(LimitedSolvers::may_begin());
    CHECK(!LimitedSolvers::may_begin());
  }
  CHECK(LimitedSolvers::may_begin());
  const LimitedSolvers past({Clock::now() - std::chrono::seconds(1), {}});
  const LimitedSolvers later({Clock::now() + std::chrono::hours(1), {}});
  CHECK(LimitedSolvers::is_over());
  CHECK(!LimitedSolvers::may_begin());
  CHECK(LimitedSolvers::milliseconds_left(1000) == 1);
}

TEST_CASE("limits are those of a thread") {
  const LimitedSolvers none(programs(0));
  bool may = false;
  std::thread([&] { may = LimitedSolvers::may_begin(); }).join();
  CHECK(may);
  CHECK(!LimitedSolvers::may_begin());
}
