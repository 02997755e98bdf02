// SPDX-License-Identifier: GPL-3.0-or-later
// What answers of the search over facets have to keep.
#pragma once

#include <doctest/doctest.h>

#include "input_design/facets_problems.hpp"

namespace cordon::examples {

using designers::SearchResult;

/// What every answer with an input has to keep.
inline void check_answer(const SeparationProblem& problem, const SearchResult& found) {
  REQUIRE(found.u);
  CHECK(found.cost == problem.cost.at(*found.u));
  CHECK(found.lower_bound <= found.cost);
  for (const PairProgram& pair : problem.pairs)
    CHECK(separation(pair, *found.u).kappa > problem.epsilon - 1e-8);
}

inline void check_optimal(const SeparationProblem& problem, const SearchResult& found, double cost,
                          double relative = 1e-7) {
  CHECK(found.status == DesignStatus::optimal);
  check_answer(problem, found);
  CHECK(found.cost == doctest::Approx(cost).epsilon(relative));
  CHECK(found.lower_bound >= found.cost * (1 - 1e-9));
  CHECK(found.reason.empty());
  CHECK_FALSE(found.stopped);
}

}  // namespace cordon::examples
