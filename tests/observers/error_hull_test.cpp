// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes around all errors of a gain: hulls and limits that were found independently, the observers
// whose hulls they are, what they must enclose, and that a box told one step late encloses nothing.
#include <doctest/doctest.h>

#include "observers/noisy_runs.hpp"
#include "published/gain_plants.hpp"

using namespace cordon;
using namespace gain_plants;
using namespace noisy_runs;

namespace {

Params previous(Params params) { return params.set("measurement", std::string("previous")); }

Vector half_widths(const Box& box) { return (box.upper - box.lower) / 2; }

/// Seeds of which the truth was lost, by boxes that are told `late` steps after their time.
int lost_seeds(const Model& model, const Params& params, const std::string& backend, int seeds,
               bool gaps, bool late = false) {
  const auto observer = plugins().observer("error_hull", model, plugins().backend(backend), params);
  int lost = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    Run run(model, static_cast<std::uint64_t>(seed) + 1, seed % 3 != 0);
    observer->start();
    bool inside = true;
    for (Index k = 0; k < 12; ++k) {
      const Sample sample = run.sample(k);
      const Estimate estimate = observer->step(gaps ? with_gaps(sample, run) : sample);
      if (late) run.move_on();
      inside = inside && estimate.consistent != Answer::no && holds(estimate.set, run.x);
      if (!late) run.move_on();
    }
    lost += !inside;
  }
  return lost;
}

}  // namespace

TEST_CASE("hulls of given gains, and those of observers that reduce nothing") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    const json designs = plant.reference["designs"], given_gains = plant.reference["given"];
    for (const char* name : {"kalman_steady_filter", "w_radius_filter_rho_0.5",
                             "w_radius_filter_rho_0.9", "h_infinity_filter"}) {
      CAPTURE(name);
      const Params params = given(matrix(designs[name]["gain"]));
      const std::vector<Box> found = hulls(plant, "error_hull", params);
      CHECK(distance(found, designs[name]["hulls"]) < 1e-8);
      CHECK(distance(found, hulls(plant, "gain_correction", unreduced(params))) < 1e-9);
    }
    for (const char* name :
         {"kalman_steady_predictor", "w_radius_predictor_rho_0.5", "h_infinity_predictor"}) {
      CAPTURE(name);
      const Params params = given(matrix(designs[name]["gain"]));
      const std::vector<Box> found = hulls(plant, "error_hull", previous(params));
      CHECK(distance(found, hulls(plant, "luenberger", unreduced(params))) < 1e-9);
      if (designs[name].contains("hulls")) CHECK(distance(found, designs[name]["hulls"]) < 1e-8);
    }
    if (given_gains.contains("Hinf-G")) {
      const json c = given_gains["Hinf-G"];
      CHECK(distance(hulls(plant, "error_hull", previous(given(matrix(c["gain"])))), c["hulls"]) <
            1e-8);
    }
  }
}

TEST_CASE("designed gains, and every representation") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    const json designs = plant.reference["designs"];
    const std::vector<Box> current = hulls(plant, "error_hull", {}),
                           before = hulls(plant, "error_hull", previous({}));
    CHECK(distance(current, designs["kalman_steady_filter"]["hulls"]) < 2e-4);
    CHECK(distance(before, designs["kalman_steady_predictor"]["hulls"]) < 2e-4);
    for (const char* backend : {"interval", "constrained_zonotope", "line_zonotope"})
      CHECK(distance(hulls(plant, "error_hull", {}, backend), current) < 1e-12);
  }
}

TEST_CASE("half widths in the limit, which the data do not change") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    const Index n = plant.model.linear.states(), p = plant.model.linear.outputs();
    for (const bool current : {true, false}) {
      CAPTURE(current);
      const json c =
          plant.reference["designs"][current ? "kalman_steady_filter" : "kalman_steady_predictor"];
      Params params = given(matrix(c["gain"])).set("initial_set", make_point(Vector::Zero(n)));
      if (!current) params = previous(params);
      const auto observer =
          plugins().observer("error_hull", plant.model, plugins().backend("interval"), params);
      const Vector u = Vector::Zero(plant.model.linear.inputs());
      sets::Random random(1);
      Vector last;
      for (Index k = 0; k < 20'000; ++k) {
        const Vector y = k < 10'000 ? Vector(.1 * random.cube(p)) : Vector(Vector::Zero(p));
        last = half_widths(observer->step({k, u, y}).set->interval_hull());
      }
      const Vector told = matrix(json::array({c["limit_half_widths"]})).row(0);
      CHECK((last - told).cwiseAbs().maxCoeff() < 1e-8);
      CHECK(((last - told).array() > -1e-12).all());
    }
  }
}

TEST_CASE("the truth stays inside, with and without gaps") {
  for (const Example& plant : plants()) {
    CAPTURE(plant.name);
    for (const char* type : {"kalman", "w_radius", "h_infinity"}) {
      for (const bool gaps : {false, true}) {
        CAPTURE(type);
        CAPTURE(gaps);
        CHECK(lost_seeds(plant.model, gain(type), "interval", 150, gaps) == 0);
        CHECK(lost_seeds(plant.model, previous(gain(type)), "interval", 150, gaps) == 0);
      }
    }
  }
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    CHECK(lost_seeds(random_model(seed), {}, "zonotope", 4, seed % 2 == 0) == 0);
    CHECK(lost_seeds(random_model(seed), previous({}), "interval", 4, seed % 2 == 0) == 0);
  }
}

TEST_CASE("a box that is told one step late loses the truth") {
  // x_0 = (3, 3), w = 0: x_1 = (-1.5, 6), and the box of k = 0 is X0
  const Example& plant = plants()[0];
  const auto observer =
      plugins().observer("error_hull", plant.model, plugins().backend("interval"), previous({}));
  const Vector x0{{3, 3}}, x1{{-1.5, 6}}, u = Vector::Zero(2);
  const LinearModel& m = plant.model.linear;
  const Enclosure first = observer->step({0, u, m.C * x0}).set;
  CHECK(holds(first, x0));
  CHECK_FALSE(holds(first, x1));
  CHECK(holds(observer->step({1, u, m.C * x1}).set, x1));
  for (const Example& each : plants())
    CHECK(lost_seeds(each.model, previous({}), "interval", 60, false, true) > 20);
}

TEST_CASE("a replaced set, and a start from another one") {
  const Example& plant = plants()[2];
  const auto backend = plugins().backend("zonotope");
  for (const Params& params : {Params(), previous({})}) {
    const auto observer = plugins().observer("error_hull", plant.model, backend, params),
               other = plugins().observer("error_hull", plant.model, backend, params);
    observer->start();
    for (Index k = 0; k < 3; ++k) observer->step(plant.samples[static_cast<std::size_t>(k)]);
    const Box wide{Vector{{-5, -5, -5}}, Vector{{5, 4, 3}}};
    observer->replace(backend->box(wide));
    const Box next = observer->step(plant.samples[3]).set->interval_hull();
    CHECK((half_widths(next).array() > .3).all());
    other->start(backend->box(wide));
    const Box first = other->step(plant.samples[0]).set->interval_hull();
    if (params.has("measurement")) CHECK((first.upper - wide.upper).cwiseAbs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("looking for outliers, which goes back at every sample, costs no widths") {
  Model model;  // a rotation, whose box grows where it is taken anew at every step
  LinearModel& m = model.linear;
  m.A = Matrix{{.5, -.8}, {.8, .5}};
  m.B = Matrix(2, 0);
  m.C = Matrix{{1, 0}};
  m.D = Matrix(1, 0);
  m.Bw = .01 * Matrix::Identity(2, 2);
  m.Dv = Matrix{{1}};
  model.X0 = make_box({Vector{{-1, -1}}, Vector{{1, 1}}});
  model.W = model.X0;
  model.V = make_box({Vector{{-1}}, Vector{{1}}});
  for (const Params& params : {Params(), previous({})}) {
    const auto make = [&] {
      return plugins().observer("error_hull", model, plugins().backend("interval"), params);
    };
    const auto plain = make(), watching = make();
    watching->leave_out_outliers(1, 50);
    for (const bool again : {false, true}) {
      Run run(model, 3, false);
      plain->start();
      watching->start();
      for (Index k = 0; k < 200; ++k) {
        CAPTURE(k);
        Sample sample = run.sample(k);
        const Box expected = plain->step(sample).set->interval_hull();
        if (!again && k == 20) sample.y[0] += 1000;
        const Estimate estimate = watching->step(sample);
        const Box found = estimate.set->interval_hull();
        if (again) {
          CHECK(found.lower == expected.lower);
          CHECK(found.upper == expected.upper);
          watching->replace(estimate.set);  // its own, of the same time
        }
        CHECK((half_widths(found).array() <= 20 * half_widths(expected).array()).all());
        CHECK(holds(estimate.set, run.x));
        run.move_on();
      }
    }
  }
}

TEST_CASE("an estimate of an earlier time says no more than its box") {
  const Model model = plants()[0].model;
  const auto observer = plugins().observer("error_hull", model, plugins().backend("interval"), {}),
             other = plugins().observer("error_hull", model, plugins().backend("interval"), {});
  const std::vector<Sample>& samples = plants()[0].samples;
  std::vector<Enclosure> sets;
  for (std::size_t k = 0; k < 3; ++k) {
    sets.push_back(observer->step(samples[k]).set);
    other->step(samples[k]);
  }
  observer->replace(sets[1]);  // as states of time 2
  other->replace(plugins().backend("interval")->box(sets[1]->interval_hull()));
  const Box found = observer->step(samples[3]).set->interval_hull(),
            expected = other->step(samples[3]).set->interval_hull();
  CHECK(distance({found}, {expected}) < 1e-12);
}

TEST_CASE("what it does not take is said") {
  const auto problems = [](const Model& model, const Params& params) {
    return plugins().registry.check<ObserverEntry>("error_hull",
                                                   {model, plugins().backend("interval")}, params);
  };
  CHECK(!problems(descriptor_example(), {}).empty());
  Model model = plants()[2].model;
  CHECK(problems(model, given(Matrix::Constant(3, 2, 10)))[0].pointer == "/gain");
  model.X0 = make_space(3);
  CHECK(problems(model, {}).size() == 1);
  model = plants()[2].model;
  model.linear.A_radius = Matrix::Constant(3, 3, .01);
  CHECK(problems(model, {})[0].message.find("interval matrices") != std::string::npos);
}

TEST_CASE("all problems are told at once, of noises that no backend of boxes holds as well") {
  Model model = plants()[2].model;
  const Params wrong = given(Matrix::Constant(3, 2, 10));
  for (const char* backend : {"zonotope", "interval", "line_zonotope"}) {
    CAPTURE(backend);
    const auto problems = [&](const Params& params) {
      return plugins().registry.check<ObserverEntry>("error_hull",
                                                     {model, plugins().backend(backend)}, params);
    };
    Params both = wrong;
    both.set("initial_set", make_space(3));
    CHECK(problems(both).size() == 2);
    model.V = make_space(model.V.dim());
    REQUIRE(problems(wrong).size() == 1);
    CHECK(problems(wrong)[0].message.find("the system's V") != std::string::npos);
    model.V = plants()[2].model.V;
  }
}
