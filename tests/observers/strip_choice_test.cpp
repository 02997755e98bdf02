// SPDX-License-Identifier: GPL-3.0-or-later
// A motor whose current is not measured and whose speed is, with a disturbance of the load: states of very different sizes.
#include <doctest/doctest.h>

#include "cordon/sets/sampling.hpp"
#include "diagnosis/banks.hpp"

using namespace cordon;
using namespace banks;

namespace {

Model motor() {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{0.6042788092736908, -0.019626482229707934}, {0.1962648222970793, 0.9948458056448786}};
  m.B = Matrix{{0.19653078447475852}, {0.026596217767921742}};
  m.Bw = Matrix{{0.026596217767921742}, {-2.494572578329228}};
  m.C = Matrix{{0, 1}};
  m.D = Matrix{{0}};
  m.Dv = Matrix{{1}};
  model.X0 = make_box({Vector{{-2, -5}}, Vector{{2, 5}}});
  model.W = make_box({Vector{{-.05}}, Vector{{.05}}});
  model.V = make_box({Vector{{-1}}, Vector{{1}}});
  model.U = make_space(1);
  return model;
}

/// The mean over 200 steps of the largest half width of the estimate.
double mean_radius(const std::string& backend, const Params& params, std::int64_t generators) {
  const Model model = motor();
  const auto observer = registry().make_observer("prediction_correction", {model, registry().make_backend(backend, params)},
                                                 Params().set("max_generators", generators));
  sets::Random random(1);
  Vector x{{1, -2}};
  double sum = 0;
  constexpr int steps = 200;
  for (Index k = 0; k < steps; ++k) {
    const Vector u = Vector::Constant(1, k / 50 % 2 == 0 ? 12.0 : -12.0);
    const Estimate estimate = observer->step({k, u, model.linear.C * x + random.cube(1)});
    CHECK(estimate.set->contains(x) != Answer::no);
    const Box hull = estimate.set->interval_hull();
    sum += ((hull.upper - hull.lower) / 2).maxCoeff();
    x = model.linear.A * x + model.linear.B * u + model.linear.Bw * (.05 * random.cube(1));
  }
  return sum / steps;
}

}  // namespace

TEST_CASE("with the smallest hulls, zonotopes are no wider than intervals, and no wider with more generators") {
  const Params hull = Params().set("strip", std::string("hull"));
  const double intervals = mean_radius("interval", {}, 20);
  double before = mean_radius("zonotope", hull, 8);
  CHECK(before < intervals);
  for (const std::int64_t generators : {20, 60}) {
    const double radius = mean_radius("zonotope", hull, generators);
    CHECK(radius <= before * (1 + 1e-9));
    before = radius;
  }
  // the F-radius does not see how many short generators add up
  CHECK(mean_radius("zonotope", Params().set("strip", std::string("segment")), 20) > 1.5 * intervals);
}
