// SPDX-License-Identifier: GPL-3.0-or-later
// Interval matrices in prediction and correction, and in the Luenberger observer with gains that
// follow the set.
#include <algorithm>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include "interval_observers/uncertain_models.hpp"

using namespace cordon;
using namespace uncertain;

namespace {

void expect_truth_inside(const std::string& observer_name, const std::string& name,
                         const Model& model, const Params& params) {
  const auto observer =
      registry().make<ObserverEntry>(observer_name, {model, backend(name)}, params);
  Truth truth(model, random_draw(), *rc::gen::arbitrary<bool>());
  for (Index k = 0; k < 8; ++k) {
    const Vector x = truth.x, u = random_matrix(model.linear.inputs(), 1, 3).col(0);
    const Vector y = truth.step(u);
    const Estimate estimate = observer->step({k, u, y});
    RC_ASSERT(estimate.consistent != Answer::no);
    RC_ASSERT(may_contain(estimate.set, x));
  }
}

/// One state, one input, one output; W and V are points.
Model scalar() {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.5}};
  m.B = Matrix{{1}};
  m.Bw = Matrix{{1}};
  m.C = Matrix{{2}};
  m.D = Matrix{{0}};
  m.Dv = Matrix{{1}};
  model.X0 = make_box({Vector{{1}}, Vector{{3}}});
  model.W = make_point(Vector{{0}});
  model.V = make_point(Vector{{0}});
  return model;
}

/// The hull at k = 1 for y_0, y_1 and u_0 = -2, u_1 = 0.
Box second_hull(const Model& model, double y0, double y1, const std::string& name = "interval") {
  const auto observer =
      registry().make<ObserverEntry>("prediction_correction", {model, backend(name)}, {});
  observer->step({0, Vector::Constant(1, -2), Vector::Constant(1, y0)});
  return observer->step({1, Vector::Constant(1, 0), Vector::Constant(1, y1)}).set->interval_hull();
}

void check_interval(const Box& hull, double lower, double upper) {
  CHECK(hull.lower[0] == doctest::Approx(lower).epsilon(1e-10));
  CHECK(hull.upper[0] == doctest::Approx(upper).epsilon(1e-10));
}

}  // namespace

TEST_CASE(
    "prediction and correction keep to the truth, whatever the matrices in their intervals are") {
  for (const char* name : backends()) {
    CAPTURE(name);
    CHECK(rc::check("the truth stays inside", [&] {
      expect_truth_inside("prediction_correction", name, random_model(*rc::gen::arbitrary<bool>()),
                          {});
    }));
  }
}

TEST_CASE("nothing known of the state at the start") {
  CHECK(rc::check("the truth stays inside", [&] {
    const Model model = random_model(*rc::gen::arbitrary<bool>());
    Params params;
    params.set("initial_set", make_space(model.linear.states()));
    expect_truth_inside("prediction_correction", "line_zonotope", model, params);
  }));
}

TEST_CASE("the gain that follows the set keeps to the truth as well") {
  for (const char* name : backends()) {
    CAPTURE(name);
    CHECK(rc::check("the truth stays inside", [&] {
      const Model model = random_model(*rc::gen::arbitrary<bool>());
      Params params;
      params.set("gain", std::make_shared<const ComponentSpec>(ComponentSpec{"kalman", {}}));
      expect_truth_inside("luenberger", name, model, params);
    }));
  }
}

TEST_CASE("a correction by a gain keeps to the truth") {
  for (const char* name : backends()) {
    CAPTURE(name);
    CHECK(rc::check("the truth stays inside", [&] {
      expect_truth_inside("gain_correction", name, random_model(*rc::gen::arbitrary<bool>()), {});
    }));
  }
}

TEST_CASE("interval matrices by hand, where strips cut exactly") {
  for (const char* name : {"interval", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(name);
    Model model = scalar();
    model.linear.C_radius = Matrix{{1}};
    // 2 x_0 ∈ 4 ± 1 · 3 leaves [1, 3], x_1 ∈ [-1.5, -.5], 2 x_1 ∈ 0 ± 1 · 1.5
    check_interval(second_hull(model, 4, 0, name), -.75, -.5);
    model.linear.A_radius = model.linear.C_radius = Matrix{{.1}};
    // 2 x_0 ∈ 3 ± .3, x_1 ∈ .5 [1.35, 1.65] ± .1 · 1.65 - 2 = [-1.49, -1.01], 2 x_1 ∈ -2.5 ± .149
    check_interval(second_hull(model, 3, -2.5, name), -1.3245, -1.1755);
    model.linear.B_radius = Matrix{{.05}};  // x_1 ∈ [-1.59, -.91], 2 x_1 ∈ -2.5 ± .159
    check_interval(second_hull(model, 3, -2.5, name), -1.3295, -1.1705);
  }
}

TEST_CASE("interval matrices and ranges of effectiveness by hand") {
  Model model = scalar();
  model.linear.C_radius = Matrix{{.1}};
  model.linear.sensor = Box{Vector{{.5}}, Vector{{1}}};
  // by the measurement |C x| ≤ 1.5 / .5: 1.5 x_0 ∈ 1.5 ± .25 · 3 ± .75 · .3, x_0 ≤ 1.65
  check_interval(second_hull(model, 1.5, -1.5), -1.5, -1.175);
  model.linear.sensor = Box{Vector{{0}}, Vector{{1}}};
  // by the set |C x| ≤ 6 + .3: x_0 ∈ -2 ± .5 · 6.3 ± .5 · .3, x_0 ≤ 1.3
  check_interval(second_hull(model, -2, 0), -1.5, -1.35);
  model.X0 = make_box({Vector{{-3}}, Vector{{-1}}});
  check_interval(second_hull(model, 2, 0), -2.65, -2.5);  // x_0 ≥ -1.3
  model = scalar();
  model.linear.B_radius = Matrix{{.1}};
  model.linear.actuator = Box{Vector{{.5}}, Vector{{1}}};
  model.V = make_box({Vector{{-100}}, Vector{{100}}});
  check_interval(second_hull(model, 0, 0), -1.7, .7);  // [.5, 1.5] - 1.5 ± .25 · 2 ± .1 · 2
}

TEST_CASE("what nothing bounds is left open, what is exact is used") {
  Model model = scalar();
  LinearModel& m = model.linear;
  m.A = Matrix{{.5, 0}, {.2, .5}};
  m.A_radius = Matrix{{.1, 0}, {0, 0}};
  m.B = Matrix(2, 0);
  m.Bw = Matrix::Zero(2, 1);
  m.C = Matrix{{1, 0}, {0, 1}, {1, 1}};
  m.C_radius = Matrix{{.1, 0}, {0, 0}, {0, 0}};
  m.D = Matrix(3, 0);
  m.Dv = Matrix{{1}, {1}, {0}};
  model.X0 = make_space(2);
  model.V = make_box({Vector{{-.5}}, Vector{{.5}}});
  const auto observer = registry().make<ObserverEntry>("prediction_correction",
                                                       {model, backend("line_zonotope")}, {});
  Box hull = observer->step({0, Vector(0), Vector{{1, 2, 3}}}).set->interval_hull();
  // y_2 gives x_2 ∈ 2 ± .5, y_3 exactly x_1 + x_2 = 3; y_1 says nothing while x_1 is unbounded
  check_interval(hull, .5, 1.5);
  CHECK(hull.lower[1] == doctest::Approx(1.5));
  hull = observer->step({1, Vector(0), Vector{{.5, 1.2, 1.7}}}).set->interval_hull();
  CHECK(hull.is_bounded());

  model.linear.C = Matrix{{1, 0}, {0, 1}, {0, 1}};
  const auto blind = registry().make<ObserverEntry>("prediction_correction",
                                                    {model, backend("line_zonotope")}, {});
  for (Index k = 0; k < 3; ++k)
    hull = blind->step({k, Vector(0), Vector{{1, 2, 2}}}).set->interval_hull();
  CHECK(hull.lower[0] == -infinity);  // only ever seen through the interval
  CHECK(hull.upper[0] == infinity);
  CHECK(hull.upper[1] < 3);
}

TEST_CASE("only exact matrices make exact sets") {
  const auto claim = [](const Model& model) {
    const auto observer = registry().make<ObserverEntry>(
        "prediction_correction", {model, backend("constrained_zonotope")}, {});
    observer->step({0, Vector::Constant(1, 0), Vector::Constant(1, 4)});
    return observer->step({1, Vector::Constant(1, 0), Vector::Constant(1, 2)}).set.tightness;
  };
  Model model = scalar();
  CHECK(claim(model) == Tightness::exact);
  model.linear.A_radius = model.linear.B_radius = model.linear.C_radius = Matrix{{0}};
  CHECK(claim(model) == Tightness::exact);
  for (Matrix* radius : {&model.linear.A_radius, &model.linear.B_radius, &model.linear.C_radius}) {
    *radius = Matrix{{.1}};
    CHECK(claim(model) == Tightness::outer);
    *radius = Matrix{};
  }
}

TEST_CASE("observers say in advance that noises are unbounded and their sets are not") {
  for (const std::string set : {"W", "V"}) {
    Model model = scalar();
    (set == "W" ? model.W : model.V) = make_space(1);
    for (const char* observer : {"prediction_correction", "luenberger", "zonotope_uncertain"}) {
      CAPTURE(observer);
      const auto problems =
          registry().check<ObserverEntry>(observer, {model, backend("zonotope")}, {});
      const auto told = std::count_if(problems.begin(), problems.end(), [&](const auto& problem) {
        return problem.message.find("the system's " + set + " is unbounded") != std::string::npos;
      });
      CHECK(told == 1);
    }
    CHECK(registry()
              .check<ObserverEntry>("prediction_correction", {model, backend("line_zonotope")}, {})
              .empty());
  }
}

TEST_CASE("a Luenberger observer says in advance that interval matrices need a bounded start") {
  Model model = scalar();
  model.X0 = make_space(1);
  CHECK(
      registry().check<ObserverEntry>("luenberger", {model, backend("line_zonotope")}, {}).empty());
  model.linear.B_radius = Matrix{{.1}};
  CHECK(
      registry().check<ObserverEntry>("luenberger", {model, backend("line_zonotope")}, {}).empty());
  for (Matrix* radius : {&model.linear.A_radius, &model.linear.C_radius}) {
    *radius = Matrix{{.1}};
    const auto problems =
        registry().check<ObserverEntry>("luenberger", {model, backend("line_zonotope")}, {});
    REQUIRE(problems.size() == 1);
    CHECK(problems[0].message.find("X0 is unbounded") != std::string::npos);
    *radius = Matrix{};
  }
  model.linear.A_radius = Matrix{{.1}};
  CHECK(registry()
            .check<ObserverEntry>("luenberger", {model, backend("line_zonotope")},
                                  Params().set("initial_set", make_point(Vector{{1}})))
            .empty());
}

TEST_CASE("an estimate that leaves an output out is not exact") {
  Model model = scalar();
  model.linear.C_radius = Matrix{{.25}};
  model.X0 = make_space(1);
  model.V = make_box({Vector{{-.125}}, Vector{{.125}}});
  for (const char* name : {"line_zonotope", "interval"}) {
    CAPTURE(name);
    const auto observer =
        registry().make<ObserverEntry>("prediction_correction", {model, backend(name)}, {});
    const Estimate first = observer->step({0, Vector{{0}}, Vector{{1}}});
    CHECK(first.set->is_bounded() != Answer::yes);
    CHECK(first.set.tightness == Tightness::outer);
  }
}
