// SPDX-License-Identifier: GPL-3.0-or-later
// What `cordon conform` asks of every observer, where observers for formulas once failed.
#include <doctest/doctest.h>

#include "input_design/plugins.hpp"
#include "nonlinear/reference.hpp"

using namespace cordon;
using namespace cordon::test;

namespace {

/// x⁺ = x + u, y = x, from a known start and without noise.
Model counter() {
  Json system = {{"states", {"x"}}, {"inputs", {"u"}}};
  system["f"] = {"x + u"};
  system["g"] = {"x"};
  system["X0"] = {{"center", {0}}, {"generators", {{0.0}}}};
  system["W"] = system["V"] = {{"center", {0}}, {"generators", {{0.0}}}};
  Model model = model_of(system);
  model.W = model.V = make_point(Vector(0));
  return model;
}

}  // namespace

TEST_CASE("a nonlinear observer that begins anew gives the same bits") {
  const Model model = counter();
  Params params;
  params.set("contraction", false);
  const auto observer = examples::registry().make<ObserverEntry>(
      "nonlinear", {model, examples::backend("line_zonotope")}, params);
  const Sample first{0, Vector{{1.0}}, Vector{{0.0}}}, second{1, Vector{{0.0}}, Vector{{1.0}}};
  const LineForm before = observer->step(first).set->line_form();
  observer->step(second);
  observer->start();
  const LineForm after = observer->step(first).set->line_form();
  CHECK(before.c == after.c);
  CHECK(before.G == after.G);
  CHECK(before.A == after.A);
  CHECK(before.b == after.b);
}

TEST_CASE("a contradiction is explained by formulas, too") {
  const Model model = counter();
  for (const char* name : {"nonlinear", "nonlinear_strips"}) {
    CAPTURE(std::string(name));
    const auto observer = examples::registry().make<ObserverEntry>(
        name, {model, examples::backend("zonotope")}, Params{});
    CHECK(observer->step({0, Vector{{1.0}}, Vector{{0.0}}}).consistent != Answer::no);
    const Estimate estimate = observer->step({1, Vector{{1.0}}, Vector{{3.0}}});
    CHECK(estimate.consistent == Answer::no);
    REQUIRE(observer->contradiction());
    CHECK(observer->contradiction()->output == 0);
    CHECK(observer->contradiction()->distance == doctest::Approx(2));
  }
}

TEST_CASE("strips follow the sets that they tell, where these are the zonotopes that they hold") {
  Json system = {{"states", {"x", "y"}}};
  system["f"] = {"x", "y"};
  system["g"] = {"x - y"};
  system["X0"] = {{"center", {0, 0}}, {"generators", {{1.0, 0.0}, {0.0, 1.0}}}};
  system["W"] = system["V"] = {{"center", {0}}, {"generators", {{0.0}}}};
  Model model = model_of(system);
  model.W = model.V = make_point(Vector(0));
  for (const char* backend : {"interval", "zonotope", "constrained_zonotope"}) {
    CAPTURE(std::string(backend));
    const auto observer = examples::registry().make<ObserverEntry>(
        "nonlinear_strips", {model, examples::backend(backend)}, Params{});
    CHECK(observer->follows_its_sets() == (std::string(backend) != "interval"));
  }
}
