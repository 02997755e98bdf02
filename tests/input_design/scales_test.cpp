// SPDX-License-Identifier: GPL-3.0-or-later
// Units do not matter, and rounding is no proof.
#include <cmath>

#include <doctest/doctest.h>

#include "input_design/plugins.hpp"
#include "input_design/systems.hpp"

using namespace cordon;
using examples::backend;
using examples::numbers;
using examples::registry;

namespace {

/// Scalar models with a bounded start, whose input counts in units of 1/b.
ModeBank bounded_scalar_models(double b, double size = 1) {
  ModeBank bank = examples::three_scalar_models();
  for (Mode& mode : bank.modes) {
    mode.model.linear.B(0, 0) = b;
    mode.model.X0 = mode.model.W = mode.model.V = examples::cube(1, .1 * size);
    mode.model.U = examples::cube(1, 2 * size / b);
  }
  return bank;
}

DesignOutcome designed(const ModeBank& bank, const char* designer, Params params) {
  DesignControl control;
  return registry()
      .make<DesignerEntry>(designer, {bank, backend("line_zonotope")}, params.set("epsilon", .1))
      ->design(control);
}

}  // namespace

TEST_CASE("The optimum does not depend on the units of inputs and of the whole system") {
  for (const double b : {1e-9, 1e-3, 1.0, 1e6, 1e12}) {
    CAPTURE(b);
    const DesignOutcome outcome =
        designed(bounded_scalar_models(b), "facets", Params().set("horizon", std::int64_t{2}));
    CHECK(outcome.status == DesignStatus::optimal);
    REQUIRE(outcome.best);
    CHECK(outcome.best->cost * b == doctest::Approx(.825).epsilon(1e-8));
    CHECK(outcome.best->separates() == Answer::yes);
  }
  for (const double size : {1e-12, 1e-6, 1e6}) {
    CAPTURE(size);
    const DesignOutcome outcome = designed(bounded_scalar_models(1, size), "facets",
                                           Params().set("horizon", std::int64_t{2}));
    CHECK(outcome.status == DesignStatus::optimal);
    REQUIRE(outcome.best);
    CHECK(outcome.best->cost / size == doctest::Approx(.825).epsilon(1e-8));
  }
}

TEST_CASE("An input that counts in small units is not overlooked beside another one") {
  // Two decoupled systems; the second input does the same for a millionth of the cost.
  ModeBank bank;
  for (const double a : {1.0, .2}) {
    Model model;
    model.linear.A = examples::diagonal({a, a});
    model.linear.B = examples::diagonal({1, 1e12});
    model.linear.Bw = model.linear.C = model.linear.Dv = Matrix::Identity(2, 2);
    model.linear.D = Matrix::Zero(2, 2);
    model.X0 = model.W = model.V = examples::cube(2, .1);
    model.U = make_box({numbers({-2, -2e-12}), numbers({2, 2e-12})});
    bank.modes.push_back({a == 1 ? "slow" : "fast", std::move(model)});
  }
  const DesignOutcome outcome = designed(bank, "facets", Params().set("horizon", std::int64_t{2}));
  CHECK(outcome.status == DesignStatus::optimal);
  REQUIRE(outcome.best);
  CHECK(outcome.best->cost < 1e-11);
  CHECK(outcome.best->u.col(0).isZero(1e-15));
}

TEST_CASE("What differs by less than rounding is neither told apart nor called the same") {
  const auto models = [](double noise) {
    ModeBank bank;
    for (const double b : {1.0, 1 + 1e-14}) {
      Model model;
      model.linear = {{},
                      Matrix::Zero(1, 1),
                      Matrix::Constant(1, 1, b),
                      Matrix::Ones(1, 1),
                      Matrix::Ones(1, 1),
                      Matrix::Zero(1, 1),
                      Matrix::Ones(1, 1)};
      model.X0 = model.W = make_point(numbers({0}));
      model.V = noise > 0 ? examples::cube(1, noise) : make_point(numbers({0}));
      model.U = examples::cube(1, 500);
      bank.modes.push_back({b == 1 ? "one" : "a little more", std::move(model)});
    }
    return bank;
  };
  for (const double noise : {0.0, 1e-16, 1e-13}) {  // exactly, y_1 differs by 5e-12
    CAPTURE(noise);
    const DesignOutcome given = designed(
        models(noise), "given", Params().set("input", Matrix(Matrix::Constant(2, 1, 500))));
    CHECK(given.best->pairs[0].disjoint == Answer::unknown);
    for (const char* designer : {"facets", "milp"}) {
      const DesignOutcome outcome =
          designed(models(noise), designer, Params().set("horizon", std::int64_t{1}));
      CHECK(outcome.status != DesignStatus::infeasible);
    }
  }
}

TEST_CASE("κ keeps its digits where it is large") {
  const ModeBank bank = bounded_scalar_models(1);
  for (const double u : {1e3, 1e6, 1e9, 1e12}) {
    CAPTURE(u);
    const DesignOutcome given = designed(
        bank, "given", Params().set("input", Matrix((Matrix(3, 1) << u, 0, 0).finished())));
    double smallest = INFINITY;
    for (const PairSeparation& pair : given.best->pairs) {
      CHECK(pair.kappa_lower > pair.kappa * (1 - 1e-6));
      smallest = std::min(smallest, pair.kappa);
    }
    CHECK(smallest == doctest::Approx(u / .75 - 1).epsilon(1e-6));
  }
}
