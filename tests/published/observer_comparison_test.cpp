// SPDX-License-Identifier: GPL-3.0-or-later
// Observers on two plants of the literature [Alamo2005, sec. 7.1; a vehicle's lateral motion];
// expected hulls of the last estimate as published with the CORA toolbox and reproduced
// independently.
#include <cmath>

#include <doctest/doctest.h>

#include "comparison_models.hpp"

using namespace cordon;
using namespace comparison;

namespace {

void check_last(const Model& model, const std::string& data, const std::string& backend,
                Params backend_params, std::int64_t generators, std::int64_t constraints,
                const Box& expected) {
  const Plugins plugins;
  Params params;
  params.set("max_generators", generators).set("max_constraints", constraints);
  const auto observer = plugins.observer(
      "prediction_correction", model, plugins.backend(backend, std::move(backend_params)), params);
  observer->start();
  Estimate estimate;
  for (const Sample& sample : samples(data, model.linear.inputs()))
    estimate = observer->step(sample);
  const Box hull = estimate.set->interval_hull();
  for (Index i = 0; i < 2; ++i) {
    CAPTURE(i);
    CHECK(std::abs(hull.lower[i] - expected.lower[i]) <= 1e-6);
    CHECK(std::abs(hull.upper[i] - expected.upper[i]) <= 1e-6);
  }
}

const Box exact_two_states{Vector{{-0.1062309346120359, -0.2540037859300612}},
                           Vector{{0.1411256696418789, 0.212784605551955}}};
const Box exact_vehicle{Vector{{-0.1808439583069218, 0.2870340937441625}},
                        Vector{{0.1636688236433201, 0.3003674270774961}}};

Params choices(const std::string& reduction, const std::string& strip) {
  Params p;
  p.set("reduction", reduction).set("strip", strip);
  return p;
}

}  // namespace

TEST_CASE("unreduced constrained and line zonotopes are the exact recursion") {
  check_last(two_states(), "observer_2dim", "constrained_zonotope", {}, 10000, 10000,
             exact_two_states);
  check_last(two_states(), "observer_2dim", "line_zonotope", {}, 10000, 10000, exact_two_states);
}

TEST_CASE("the exact recursion of the vehicle over 100 steps") {
  check_last(vehicle(), "observer_vehicle", "constrained_zonotope", {}, 100000, 100000,
             exact_vehicle);
}

TEST_CASE("zonotopes and strips of least F-radius") {
  check_last(two_states(), "observer_2dim", "zonotope", choices("girard", "segment"), 40, 0,
             {Vector{{-0.1252836718233518, -0.3590605415736482}},
              Vector{{0.1755077905850537, 0.3031460898598283}}});
}

TEST_CASE("principal axes with strips of least F-radius: rows of rounding noise give none") {
  check_last(vehicle(), "observer_vehicle", "zonotope", choices("pca", "segment"), 200, 0,
             {Vector{{-0.3090888964793908, 0.2849144661504785}},
              Vector{{0.3031670983142311, 0.3022650442095819}}});
}

TEST_CASE("zonotopes and strips of least volume among the parallel ones") {
  check_last(two_states(), "observer_2dim", "zonotope", choices("girard", "bravo"), 40, 0,
             {Vector{{-0.1148743303581211, -0.3792153944480451}},
              Vector{{0.141125669641879, 0.212784605551955}}});
}

TEST_CASE("a gap in time, a repeated sample and a replacement before the start are refused") {
  const Plugins plugins;
  const auto observer =
      plugins.observer("prediction_correction", two_states(), plugins.backend("zonotope"));
  observer->start();
  CHECK_THROWS_AS(observer->replace(plugins.backend("zonotope")->box(cube(2, 1))), Error);
  const auto all = samples("observer_2dim", 2);
  observer->step(all[0]);
  CHECK_THROWS_AS(observer->step(all[0]), Error);
  CHECK_THROWS_AS(observer->step(all[2]), Error);
  CHECK(observer->step(all[1]).consistent != Answer::no);
}
