// SPDX-License-Identifier: GPL-3.0-or-later
// Threads of a bank keep to the limits of the thread that they work for.
#include "diagnosers/mode_workers.hpp"

#include <atomic>

#include <doctest/doctest.h>

#include "cordon/solvers/limits.hpp"

using namespace cordon;

TEST_CASE("each mode has the limits of the caller, and tells what it has left open") {
  for (const Index threads : {1, 2, 4}) {
    CAPTURE(threads);
    estimators::ModeWorkers workers(threads);
    const auto begun = [&](std::int64_t most, int wanted) {
      const LimitedSolvers solvers({{}, most});
      std::atomic<int> count = 0;
      workers.for_each(6, [&](Index) {
        for (int i = 0; i < wanted; ++i) count += LimitedSolvers::may_begin() ? 1 : 0;
      });
      CHECK(solvers.left_open() == (wanted > most));
      return count.load();
    };
    CHECK(begun(2, 3) == 12);
    CHECK(begun(3, 3) == 18);
    const LimitedSolvers past({SolverLimits::Clock::now(), {}});
    std::atomic<int> over = 0;
    workers.for_each(6, [&](Index) { over += LimitedSolvers::is_over() ? 1 : 0; });
    CHECK(over == 6);
    CHECK(past.left_open());
  }
}
