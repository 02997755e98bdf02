// SPDX-License-Identifier: GPL-3.0-or-later
// Designs at the edge of input sets, of what tubes allow, and of separation.
#include <cmath>

#include <doctest/doctest.h>

#include "cordon/solvers/exact_questions.hpp"
#include "input_design/plugins.hpp"
#include "input_design/systems.hpp"

using namespace cordon;
using examples::backend;
using examples::numbers;
using examples::registry;

namespace {

Matrix one(double value) { return Matrix::Constant(1, 1, value); }

/// y_0 = g u_0 + v and y_1 = b u_0 + w + v.
Model scalar(double b, double g) {
  Model model;
  model.linear = {{}, one(0), one(b), one(1), one(1), one(g), one(1)};
  model.X0 = make_point(numbers({0}));
  model.W = model.V = examples::cube(1, .25);
  model.U = examples::cube(1, 4);
  return model;
}

/// 0 = x + b u + w, y = b u + v with x_0 = 0: u_0 may be .25 / b at most.
Model static_scalar(double b) {
  Model model;
  model.linear = {one(0), one(1), one(b), one(1), one(0), one(b), one(1)};
  model.X0 = make_point(numbers({0}));
  model.W = examples::cube(1, .25);
  model.V = examples::cube(1, .125);
  model.U = examples::cube(1, 4);
  return model;
}

DesignOutcome designed(const ModeBank& bank, const Params& params) {
  REQUIRE(
      registry().check<DesignerEntry>("facets", {bank, backend("line_zonotope")}, params).empty());
  DesignControl control;
  return registry()
      .make<DesignerEntry>("facets", {bank, backend("line_zonotope")}, params)
      ->design(control);
}

Params at_horizon_1(const std::string& cost, double r_0, double r_1) {
  return Params()
      .set("horizon", std::int64_t{1})
      .set("cost", cost)
      .set("reference", Matrix((Matrix(2, 1) << r_0, r_1).finished()));
}

}  // namespace

TEST_CASE("Inputs lie in a polytope with constraints, whatever the cost") {
  ModeBank bank;
  bank.modes = {{"a", scalar(1, 0)}, {"b", scalar(2, 0)}};
  LineForm U{Matrix(1, 0), (Matrix(1, 3) << -.5, 2.5, -.75).finished(), numbers({0}),
             Matrix(1, 0), (Matrix(1, 3) << .875, .25, -1).finished(),  numbers({-.109375})};
  const double lowest = exact::support(U, numbers({-1})).upper;  // the reference -4 lies outside
  for (const char* cost : {"norm_1", "norm_inf", "quadratic"}) {
    CAPTURE(cost);
    const DesignOutcome outcome = designed(bank, at_horizon_1(cost, 2.5, -4).set("input_set", U));
    CHECK(outcome.status == DesignStatus::optimal);
    REQUIRE(outcome.best);
    CHECK(outcome.best->u(1, 0) == doctest::Approx(-lowest).epsilon(1e-9));
    if (cost == std::string("norm_inf")) {
      CHECK(outcome.best->cost ==
            doctest::Approx(4 - lowest).epsilon(1e-9));  // which leaves u_0 some choice
    } else {
      CHECK(outcome.best->u(0, 0) == doctest::Approx(2.5).epsilon(1e-9));
    }
  }
}

TEST_CASE("An input keeps inside of what leaves every tube an output") {
  ModeBank bank;
  bank.modes = {{"a", static_scalar(1)}, {"b", static_scalar(2)}};
  for (const double reference : {-.3, 1.0}) {  // both ask for more than |u_0| = .125
    CAPTURE(reference);
    for (const char* cost : {"norm_1", "quadratic"}) {
      CAPTURE(cost);
      const DesignOutcome outcome = designed(bank, at_horizon_1(cost, reference, 0));
      REQUIRE(outcome.best);
      CHECK(outcome.best->separates() == Answer::yes);
      const double u_0 = std::copysign(.125, reference),
                   apart = .25 * (1 + 1e-4);  // u_1 tells the modes apart
      CHECK(outcome.best->u(0, 0) == doctest::Approx(u_0).epsilon(1e-8));
      CHECK(std::abs(outcome.best->u(0, 0)) < .125);
      const double far = std::abs(reference - u_0);
      CHECK(outcome.best->cost ==
            doctest::Approx(cost == std::string("norm_1") ? far + apart : far * far + apart * apart)
                .epsilon(1e-7));
      CHECK(outcome.gap() < 1e-8);
    }
  }
}

TEST_CASE("A tube that a longer horizon empties does not refuse a shorter one") {
  ModeBank bank;
  for (const double g : {1.0, 2.0}) {
    Model model;  // x_1 doubles, and x_2 = x_1 is admissible up to 10
    model.linear.E = examples::diagonal({1, 0});
    model.linear.A = (Matrix(2, 2) << 2, 0, 1, -1).finished();
    model.linear.B = model.linear.Bw = Matrix::Zero(2, 1);
    model.linear.C = (Matrix(1, 2) << 0, 1).finished();
    model.linear.D = one(g);
    model.linear.Dv = one(1);
    model.X0 = make_box({numbers({.875, .875}), numbers({1.125, 1.125})});
    model.W = make_point(numbers({0}));
    model.V = examples::cube(1, .25);
    model.U = examples::cube(1, 4);
    bank.modes.push_back({g == 1 ? "a" : "b", std::move(model)});
  }
  const Params params = Params().set("admissible_set", examples::cube(2, 10));
  const DesignOutcome outcome = designed(bank, params);
  CHECK(outcome.status == DesignStatus::optimal);
  CHECK(outcome.horizon == 1);
  const auto problems = registry().check<DesignerEntry>(
      "facets", {bank, backend("line_zonotope")}, Params(params).set("horizon", std::int64_t{6}));
  REQUIRE(problems.size() == 2);
  for (const auto& problem : problems)
    CHECK(problem.message.find("is empty for every input") != std::string::npos);
}

TEST_CASE("What is not proven to separate is no answer") {
  ModeBank bank;
  bank.modes = {{"a", scalar(0, 1)}, {"b", scalar(0, 2)}};  // |u| ≥ .5 (1 + ε)
  for (const double epsilon : {1e-13, 1e-12}) {             // less than a proof can tell
    const DesignOutcome outcome =
        designed(bank, at_horizon_1("norm_1", 0, 0).set("epsilon", epsilon));
    CHECK(outcome.status == DesignStatus::unknown);
    CHECK_FALSE(outcome.best);
    CHECK(outcome.reason.find("rounding leaves open") != std::string::npos);
    CHECK(outcome.lower_bound == doctest::Approx(.5));
  }
  const DesignOutcome limit = designed(bank, at_horizon_1("norm_1", 0, 0).set("epsilon", 0.0));
  CHECK(limit.status == DesignStatus::optimal);
  CHECK(limit.best->cost == doctest::Approx(.5));
  CHECK(limit.reason.find("touch") != std::string::npos);
}
