// SPDX-License-Identifier: GPL-3.0-or-later
// The published example by the component "milp", as reduced as it was published: 7 and 8 generators
// per pair.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "input_design/plugins.hpp"
#include "input_design/systems.hpp"

using namespace cordon;
using examples::backend;
using examples::numbers;
using examples::registry;

TEST_CASE("Descriptor models with 7 and 8 generators per pair") {
  const ModeBank bank = examples::four_descriptor_models();
  for (const Index generators : {7, 8}) {
    const Params params = Params()
                              .set("horizon", Index{3})
                              .set("first_input", numbers({.5, -1}))
                              .set("reference", Matrix(numbers({.5, -1}).transpose()))
                              .set("max_generators", generators)
                              .set("time_limit", 600.0);
    REQUIRE(
        registry().check<DesignerEntry>("milp", {bank, backend("line_zonotope")}, params).empty());
    DesignControl control;
    const DesignOutcome outcome =
        registry()
            .make<DesignerEntry>("milp", {bank, backend("line_zonotope")}, params)
            ->design(control);
    CHECK(outcome.status == DesignStatus::feasible);
    CHECK(outcome.horizon == 3);
    CHECK_FALSE(outcome.stopped);
    REQUIRE(outcome.best);
    CHECK(outcome.best->separates() == Answer::yes);
    CHECK(outcome.best->cost >= 9.2005343);  // the proven optimum of the pairs themselves
    CHECK(outcome.best->cost < 9.25);        // the published input costs 10.5885
    CHECK(outcome.lower_bound == -std::numeric_limits<double>::infinity());
    CHECK(std::isinf(outcome.gap()));
    REQUIRE(outcome.restriction);
    CHECK(outcome.restriction->name.find("GLPK") != std::string::npos);
    CHECK(outcome.restriction->lower_bound <= outcome.best->cost);
    CHECK(outcome.restriction->lower_bound > 9.2);
    CHECK(outcome.restriction->lower_bound >= (1 - 1e-5) * outcome.best->cost);
    for (const PairSeparation& pair : outcome.best->pairs) CHECK(pair.kappa_lower >= 1e-4 - 1e-6);
  }
}

TEST_CASE("The smallest horizon that works is found") {
  const ModeBank bank = examples::three_scalar_models();
  const Params params = Params().set("max_horizon", Index{4}).set("max_generators", Index{3});
  DesignControl control;
  const DesignOutcome outcome =
      registry()
          .make<DesignerEntry>("milp", {bank, backend("line_zonotope")}, params)
          ->design(control);
  CHECK(outcome.status == DesignStatus::feasible);
  REQUIRE(outcome.best);
  CHECK(outcome.best->separates() == Answer::yes);
  CHECK(outcome.horizon == static_cast<Index>(outcome.tried.size()) + 1);
}
