// SPDX-License-Identifier: GPL-3.0-or-later
// Backends that enclose V make tubes wider: what is said of wider tubes holds of the study's own
// only where they are disjoint.
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

TEST_CASE("a search among wider tubes neither excludes inputs nor bounds their cost") {
  for (const std::string designer : {"facets", "milp"}) {
    CAPTURE(designer);
    const DesignOutcome narrow =
        answer(thin_noise(thin_zonotope(), 1.5), "interval", designer, question());
    CHECK(narrow.status == DesignStatus::unknown);  // u_0 = 5/16 does
    CHECK(narrow.lower_bound == -infinity);
    CHECK_FALSE(narrow.reason.empty());
    const DesignOutcome wide =
        answer(thin_noise(thin_zonotope(), 8), "interval", designer, question());
    CHECK(wide.status == DesignStatus::feasible);
    CHECK(wide.lower_bound == -infinity);
    REQUIRE(wide.restriction);
    CHECK(wide.restriction->lower_bound <= wide.best->cost);
  }
}

TEST_CASE("with sets as they are the same designs are optimal") {
  const DesignOutcome found =
      answer(thin_noise(thin_zonotope(), 1.5), "line_zonotope", "facets", question());
  CHECK(found.status == DesignStatus::optimal);
  CHECK(found.best->cost == doctest::Approx(5. / 16).epsilon(1e-9));
  CHECK_FALSE(found.restriction);
  const DesignOutcome boxes =
      answer(thin_noise(examples::cube(2, 1), 8), "interval", "facets", question());
  CHECK(boxes.status == DesignStatus::optimal);
}

TEST_CASE("outputs of wider tubes that can be the same may differ in the study") {
  const ModeBank bank = thin_noise(thin_zonotope(), 8);
  for (const double u : {1., 4.}) {
    const Params given =
        Params().set("input", Matrix((Matrix(2, 1) << u, 0).finished())).set("epsilon", .25);
    const DesignOutcome found = answer(bank, "interval", "given", given);
    REQUIRE(found.best);
    CHECK(found.best->pairs[0].disjoint == (u > 2 ? Answer::yes : Answer::unknown));
    CHECK(found.best->pairs[0].kappa_lower <= 0);
    const ExactSeparation exact = verify_design(bank, found);
    CHECK(exact.separates() == Answer::yes);
    CHECK(refuted_claims(bank, {"given", given}, found, &exact).empty());
  }
}
