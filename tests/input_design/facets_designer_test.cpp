// SPDX-License-Identifier: GPL-3.0-or-later
// The designer "facets" from parameters to certificates.
#include <cmath>

#include <doctest/doctest.h>

#include "input_design/plugins.hpp"
#include "input_design/systems.hpp"

using namespace cordon;
using examples::backend;
using examples::numbers;
using examples::registry;

namespace {

DesignOutcome designed(const ModeBank& bank, const Params& params) {
  REQUIRE(registry().check_designer("facets", bank, backend("line_zonotope"), params).empty());
  DesignControl control;
  return registry().make_designer("facets", bank, backend("line_zonotope"), params)->design(control);
}

Params published_parameters() {
  const Matrix reference = (Matrix(1, 2) << .5, -1).finished();
  return Params().set("reference", reference).set("first_input", Vector(reference.transpose()));
}

}  // namespace

TEST_CASE("The published example: horizons 1 and 2 are refused by proof, 3 is optimal and certified") {
  const DesignOutcome outcome = designed(examples::four_descriptor_models(), published_parameters().set("epsilon", 1e-4));
  CHECK(outcome.status == DesignStatus::optimal);
  CHECK(outcome.horizon == 3);
  REQUIRE(outcome.tried.size() == 2);
  for (const HorizonTrial& trial : outcome.tried) CHECK(trial.status == DesignStatus::infeasible);
  REQUIRE(outcome.best);
  CHECK(outcome.best->cost == doctest::Approx(9.2005343602499).epsilon(1e-9));
  CHECK(outcome.gap() <= 1e-9);
  CHECK(outcome.bounded_problem.empty());
  CHECK(outcome.best->separates() == Answer::yes);
  for (const PairSeparation& pair : outcome.best->pairs) CHECK(pair.kappa_lower > 1e-4 - 1e-8);
  CHECK(outcome.best->u.row(0).isApprox(numbers({.5, -1}).transpose()));
  CHECK(outcome.best->u.cwiseAbs().maxCoeff() <= 8);
  CHECK(outcome.facets == 100);
  CHECK(outcome.reason.empty());
}

TEST_CASE("With ε = 0 the tubes of the optimum touch, and it is said") {
  const DesignOutcome outcome =
      designed(examples::four_descriptor_models(), published_parameters().set("epsilon", 0.0).set("horizon", std::int64_t{3}));
  CHECK(outcome.status == DesignStatus::optimal);
  CHECK(outcome.best->cost == doctest::Approx(9.19954).epsilon(1e-9));
  CHECK(outcome.best->separates() != Answer::yes);
  CHECK(outcome.reason.find("touch") != std::string::npos);
}

TEST_CASE("Parameters of the search reach it") {
  Params params = published_parameters().set("epsilon", 1e-4).set("horizon", std::int64_t{3});
  const DesignOutcome few = designed(examples::four_descriptor_models(), Params(params).set("max_facets", std::int64_t{20}));
  CHECK(few.status == DesignStatus::unknown);
  CHECK(few.reason.find("more than 20 facets") != std::string::npos);
  const DesignOutcome wide = designed(examples::four_descriptor_models(), Params(params).set("gap", .5));
  CHECK(wide.status == DesignStatus::optimal);
  CHECK(wide.lower_bound < 9.2005);
  const DesignOutcome last = designed(examples::four_descriptor_models(), Params(params).set("outputs", std::string("last")));
  CHECK(last.last_output_only);
  CHECK((!last.best || last.best->cost > 9.2005));
}
