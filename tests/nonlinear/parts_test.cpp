// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes that are cut into parts for the prediction.
#include <algorithm>
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "input_design/plugins.hpp"
#include "nonlinear/methods.hpp"
#include "nonlinear/reference.hpp"
#include "nonlinear/trajectory.hpp"
#include "observers/nonlinear/box_parts.hpp"
#include "observers/nonlinear/recursion.hpp"

using namespace cordon;
using namespace cordon::test;
using estimators::BoxCuts;
using estimators::NonlinearRecursion;

TEST_CASE("sides are halved by doubt times width, those without doubt never") {
  const Box B{Vector{{0, 0, 0}}, Vector{{1, 8, 1}}};
  CHECK(estimators::cuts_of(B, Vector{{1, 1, 0}}, 4).counts == std::vector<Index>{1, 4, 1});
  CHECK(estimators::cuts_of(B, Vector{{8, 1, 0}}, 4).counts == std::vector<Index>{2, 2, 1});
  CHECK(estimators::cuts_of(B, Vector{{1, 1, infinity}}, 8).counts == std::vector<Index>{1, 1, 8});
  CHECK(estimators::cuts_of(B, Vector{{0, 0, 0}}, 64).parts() == 1);
  CHECK(estimators::cuts_of(B, Vector{{1, 1, 1}}, 63).parts() == 32);
  const Box point{Vector{{2, 0}}, Vector{{2, 1}}};
  CHECK(estimators::cuts_of(point, Vector{{1, 0}}, 64).parts() == 1);
}

TEST_CASE("parts cover the box") {
  std::mt19937_64 random(1);
  const Box B{Vector{{-1.7e308, 0.1, 5e-324}}, Vector{{1.7e308, 0.1 + 1e-16, 2e-323}}};
  const std::vector<Box> parts = estimators::parts_of(B, {{4, 8, 2}});
  REQUIRE(parts.size() == 64);
  Box hull = Box::empty(3);
  for (const Box& part : parts) {
    CHECK_FALSE(part.is_empty());
    hull = estimators::hull_of(hull, part);
  }
  CHECK(hull.lower == B.lower);
  CHECK(hull.upper == B.upper);
  for (int i = 0; i < 1000; ++i) {
    Vector x = B.lower;
    for (double& value : x) {
      const double t = std::uniform_real_distribution<double>(0, 1)(random);
      const Index coordinate = static_cast<Index>(&value - x.data());
      value = std::clamp((1 - t) * B.lower[coordinate] + t * B.upper[coordinate],
                         B.lower[coordinate], B.upper[coordinate]);
    }
    CHECK(std::ranges::any_of(parts, [&](const Box& part) { return part.contains(x); }));
  }
}

namespace {

struct Widths {
  double whole = 0, in_parts = 0;  ///< of the last hull, sums over the coordinates
};

/// The example by one method, whole and in parts: parts hold what is attained.
Widths compare_parts(const Json& example, const Method& method) {
  const auto model = model_of(example["system"]);
  Widths widths;
  for (const Index parts : {1, 16}) {
    NonlinearOptions options = method.options;
    options.parts = parts;
    const auto backend = examples::backend(method.backend);
    NonlinearRecursion recursion(model, backend, options);
    recursion.start(backend->import(model.X0));
    for (std::size_t k = 0; k < example["y"].size(); ++k) {
      CAPTURE(k);
      if (k > 0) recursion.predict(vector_of(example["u"][k - 1]), static_cast<Index>(k) - 1);
      REQUIRE(recursion.correct(
          {static_cast<Index>(k), vector_of(example["u"][k]), vector_of(example["y"][k])}));
      const Box inner = box_of(example["inner_hulls"][k]);
      CHECK((recursion.box().lower.array() <= inner.lower.array()).all());
      CHECK((inner.upper.array() <= recursion.box().upper.array()).all());
      CHECK(recursion.box().contains(vector_of(example["truth"][k])));
    }
    (parts == 1 ? widths.whole : widths.in_parts) = 2 * recursion.box().radius().sum();
  }
  return widths;
}

}  // namespace

TEST_CASE("examples in parts: what is attained stays inside, and boxes become narrower") {
  const Json all = reference();
  for (const Json& example : all["examples"]) {
    for (const Method& method : methods()) {
      if (!method.options.boxes_only && !method.options.carries_box) continue;
      const std::string name = example["name"], called = method.reference;
      CAPTURE(name);
      CAPTURE(called);
      const Widths widths = compare_parts(example, method);
      CHECK(widths.in_parts <= widths.whole * (1 + 1e-9));
      if (called == "interval_natural" && name == "two_tank")
        CHECK(widths.in_parts < 0.5 * widths.whole);
    }
  }
}

TEST_CASE("trajectories stay inside of boxes in parts") {
  const Json all = reference();
  for (const Json& example : all["examples"]) {
    if (example["name"] == "heading") continue;  // disturbances leave its invariant
    const auto model = model_of(example["system"]);
    for (Method method : methods()) {
      if (!method.options.boxes_only && !method.options.carries_box) continue;
      CAPTURE(example["name"].get<std::string>());
      CAPTURE(std::string(method.reference));
      method.options.parts = 8;
      method.options.budget = {12, 4};
      const auto backend = examples::backend(method.backend);
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        NonlinearRecursion recursion(model, backend, method.options);
        Trajectory trajectory(model, seed);
        recursion.start(backend->import(model.X0));
        try {
          for (Index k = 0; k < 20; ++k) {
            const Vector u = vector_of(example["u"][as_size(k) % example["u"].size()]);
            REQUIRE(recursion.correct({k, u, trajectory.output(u, k)}));
            recursion.reduce();
            REQUIRE(recursion.box().contains(trajectory.x()));
            REQUIRE(recursion.set()->contains(trajectory.x()) != Answer::no);
            recursion.predict(u, k);
            trajectory.advance(u, k);
          }
        } catch (const Error& error) {
          CHECK(error.code() == Errc::not_enclosed);
        }
      }
    }
  }
}

TEST_CASE("a root that is not defined over the whole box is over its parts") {
  // The range of a² - a + 0.35 over [0, 1] is [0.1, 0.35], its natural extension is [-0.65, 1.35].
  Json system = {{"states", {"a"}}, {"disturbances", {"w"}}, {"noises", {"v"}}};
  system["f"] = {"sqrt(a^2 - a + 0.35) + w"};
  system["g"] = {"a + v"};
  system["X0"] = {{"center", {0.5}}, {"generators", {{0.5}}}};
  system["W"] = {{"center", {0}}, {"generators", {{0.01}}}};
  system["V"] = {{"center", {0}}, {"generators", {{1}}}};
  const auto model = model_of(system);
  for (Method method : methods()) {
    if (!method.options.boxes_only && !method.options.carries_box) continue;
    CAPTURE(std::string(method.reference));
    for (const Index parts : {1, 64}) {
      method.options.parts = parts;
      const auto backend = examples::backend(method.backend);
      NonlinearRecursion recursion(model, backend, method.options);
      recursion.start(backend->import(model.X0));
      REQUIRE(recursion.correct({0, Vector(0), Vector{{0.5}}}));
      if (parts == 1 || method.options.relaxes) {
        CHECK_THROWS_AS(recursion.predict(Vector(0), 0), Error);
        continue;
      }
      REQUIRE(recursion.predict(Vector(0), 0));
      REQUIRE(recursion.correct({1, Vector(0), Vector{{0.5}}}));
      CHECK(recursion.box().lower[0] <= std::sqrt(0.1) - 0.01);
      CHECK(recursion.box().upper[0] >= std::sqrt(0.35) + 0.01);
      CHECK(recursion.box().lower[0] >= 0.15);
      CHECK(recursion.box().upper[0] <= 0.68);
      CHECK(recursion.set()->contains(Vector{{std::sqrt(0.1)}}) == Answer::yes);
    }
  }
}
