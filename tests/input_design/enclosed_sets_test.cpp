// SPDX-License-Identifier: GPL-3.0-or-later
// Backends that can only enclose V: what is said of tubes is said of the study's own sets, for of
// wider ones only that they are disjoint would hold.
#include <doctest/doctest.h>

#include "cordon/study/design.hpp"
#include "input_design/plugins.hpp"
#include "input_design/systems.hpp"

using namespace cordon;
using examples::backend;
using examples::numbers;
using examples::registry;

namespace {

/// x⁺ = u (1, -1), y = x + v, beside a dead actuator: along (1, -1) the noise is thin.
ModeBank thin_noise(LineForm V, double bound) {
  Model model;
  model.linear = {{},
                  Matrix::Zero(2, 2),
                  (Matrix(2, 1) << 1, -1).finished(),
                  Matrix::Zero(2, 1),
                  Matrix::Identity(2, 2),
                  Matrix::Zero(2, 1),
                  Matrix::Identity(2, 2)};
  model.X0 = make_point(numbers({0, 0}));
  model.W = make_point(numbers({0}));
  model.V = std::move(V);
  model.U = examples::cube(1, bound);
  ModeBank bank;
  bank.modes.push_back({"healthy", model});
  model.linear.B.setZero();
  bank.modes.push_back({"dead", model});
  return bank;
}

/// |v_1 - v_2| ≤ 1/4, in a box of side 9/4.
LineForm thin_zonotope() {
  return make_zonotope(numbers({0, 0}), (Matrix(2, 2) << 1, .125, 1, -.125).finished());
}

DesignOutcome answer(const ModeBank& bank, const std::string& set, const std::string& designer,
                     const Params& params) {
  const DesignerContext context{bank, backend(set)};
  REQUIRE(registry().check<DesignerEntry>(designer, context, params).empty());
  DesignControl control;
  return registry().make<DesignerEntry>(designer, context, params)->design(control);
}

Params question() { return Params().set("horizon", std::int64_t{1}).set("epsilon", .25); }

}  // namespace

TEST_CASE("designs are those of the study's sets, whatever the backend makes of them") {
  const ModeBank narrow = thin_noise(thin_zonotope(), 1.5), wide = thin_noise(thin_zonotope(), 8);
  for (const std::string set : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(set);
    for (const ModeBank& bank : {narrow, wide}) {
      const DesignOutcome found = answer(bank, set, "facets", question());
      CHECK(found.status == DesignStatus::optimal);
      REQUIRE(found.best);
      CHECK(found.best->cost == doctest::Approx(5. / 16).epsilon(1e-9));
      CHECK(found.lower_bound <= 5. / 16 + 1e-9);
    }
    CHECK(answer(narrow, set, "milp", question()).status == DesignStatus::feasible);
  }
}

TEST_CASE("outputs and κ under a given input are those of the study's sets") {
  const ModeBank bank = thin_noise(thin_zonotope(), 8);
  for (const std::string set : {"interval", "zonotope", "line_zonotope"}) {
    const Params given =
        Params().set("input", Matrix((Matrix(2, 1) << 1, 0).finished())).set("epsilon", .25);
    const DesignOutcome found = answer(bank, set, "given", given);
    REQUIRE(found.best);
    CHECK(found.best->pairs[0].disjoint == Answer::yes);
    CHECK(found.best->pairs[0].kappa == doctest::Approx(3).epsilon(1e-9));
    const ExactSeparation exact = verify_design(bank, found);
    CHECK(exact.separates() == Answer::yes);
    CHECK(refuted_claims(bank, {"given", given}, found, &exact).empty());
  }
}

TEST_CASE("κ is about a set with constraints as it is written") {
  // v = ξ_1 + ξ_2/2 with ξ_1 + ξ_2 = 1/2 grows by 1/4 less than t in size when factors grow to t
  LineForm V{Matrix(1, 0), (Matrix(1, 2) << 1, .5).finished(), numbers({0}),
             Matrix(1, 0), (Matrix(1, 2) << 1, 1).finished(),  numbers({.5})};
  Model model;
  model.linear = {{},
                  Matrix::Zero(1, 1),
                  Matrix::Ones(1, 1),
                  Matrix::Zero(1, 1),
                  Matrix::Ones(1, 1),
                  Matrix::Zero(1, 1),
                  Matrix::Ones(1, 1)};
  model.X0 = model.W = make_point(numbers({0}));
  model.V = V;
  model.U = examples::cube(1, 8);
  ModeBank bank;
  bank.modes.push_back({"healthy", model});
  model.linear.B.setZero();
  bank.modes.push_back({"dead", model});
  for (const std::string set : {"interval", "zonotope", "line_zonotope"}) {
    CAPTURE(set);
    const DesignOutcome found =
        answer(bank, set, "facets", Params().set("horizon", std::int64_t{1}).set("epsilon", .5));
    REQUIRE(found.best);
    CHECK(found.best->cost == doctest::Approx(1.25).epsilon(1e-9));
    CHECK(found.best->pairs[0].kappa == doctest::Approx(.5).epsilon(1e-9));
  }
}
