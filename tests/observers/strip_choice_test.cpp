// SPDX-License-Identifier: GPL-3.0-or-later
// How strips are cut, seen over many steps: a motor with states of very different sizes, random
// plants, small and large budgets.
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <doctest/doctest.h>

#include "cordon/sets/sampling.hpp"
#include "diagnosis/banks.hpp"

using namespace cordon;
using namespace banks;

namespace {

Model motor() {
  Model model;
  LinearModel& m = model.linear;
  m.A =
      Matrix{{0.6042788092736908, -0.019626482229707934}, {0.1962648222970793, 0.9948458056448786}};
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

/// The mean over the steps of the half widths, each as a share of that of X0, which is a box.
double mean_radius(const Model& model, const std::string& backend, const Params& params,
                   const Params& budget, int steps, unsigned seed) {
  const auto observer = registry().make<ObserverEntry>(
      "prediction_correction", {model, registry().make<BackendEntry>(backend, params)}, budget);
  const LinearModel& m = model.linear;
  const auto radius = [](const LineForm& box) { return Vector(box.G.cwiseAbs().rowwise().sum()); };
  const Vector start = radius(model.X0), w = radius(model.W), v = radius(model.V);
  sets::Random random(seed);
  Vector x = start.cwiseProduct(random.cube(m.states()));
  double sum = 0;
  for (Index k = 0; k < steps; ++k) {
    const Vector u = Vector::Constant(m.inputs(), k / 50 % 2 == 0 ? 12.0 : -12.0);
    const Estimate estimate =
        observer->step({k, u, m.C * x + v.cwiseProduct(random.cube(m.outputs()))});
    CHECK(estimate.set->contains(x) != Answer::no);
    const Box hull = estimate.set->interval_hull();
    sum += ((hull.upper - hull.lower) / 2).cwiseQuotient(start).mean();
    x = m.A * x + m.B * u + m.Bw * w.cwiseProduct(random.cube(m.disturbances()));
  }
  return sum / steps;
}

Params budget_of(std::int64_t most) { return Params().set("max_generators", most); }

double of_motor(const std::string& backend, const Params& params, std::int64_t most) {
  return mean_radius(motor(), backend, params, budget_of(most), 200, 1);
}

/// Stable or on the boundary, with a disturbance of every state or of one.
Model random_plant(unsigned seed) {
  sets::Random random(seed);
  const auto matrix = [&](Index rows, Index cols) {
    Matrix A(rows, cols);
    for (double& a : A.reshaped()) a = random.cube(1)[0];
    return A;
  };
  const auto one_of = [&](std::array<double, 3> list) {
    return list[static_cast<std::size_t>(1.4999 + 1.4999 * random.cube(1)[0])];
  };
  const Index n = 2 + seed % 4, p = 1 + seed % 3;
  Model model;
  LinearModel& m = model.linear;
  m.A = matrix(n, n);
  m.A *= one_of({.7, .9, .98}) / m.A.eigenvalues().cwiseAbs().maxCoeff();
  m.B = Matrix(n, 0);
  m.D = Matrix(p, 0);
  m.Bw = seed % 2 == 0 ? Matrix(Matrix::Identity(n, n)) : matrix(n, 1);
  m.C = matrix(p, n);
  m.Dv = Matrix::Identity(p, p);
  const auto ball = [](Index size, double radius) {
    return make_box({Vector::Constant(size, -radius), Vector::Constant(size, radius)});
  };
  model.X0 = ball(n, 1);
  model.W = ball(m.Bw.cols(), one_of({.01, .05, .1}));
  model.V = ball(p, one_of({.01, .1, 1}));
  model.U = make_space(0);
  return model;
}

}  // namespace

TEST_CASE(
    "zonotopes of a motor are about as wide as intervals, and no wider with more generators") {
  const double intervals = of_motor("interval", {}, 20);
  for (const auto& [strip, most] : {std::pair("hull", 1.0), std::pair("box", 1.4)}) {
    CAPTURE(strip);
    const Params params = Params().set("strip", std::string(strip));
    double before = of_motor("zonotope", params, 8);
    CHECK(before < most * intervals);
    for (const std::int64_t generators : {20, 60}) {
      const double radius = of_motor("zonotope", params, generators);
      CHECK(radius <= before * 1.001);
      before = radius;
    }
  }
  // a sum of squares does not see how many short generators add up
  CHECK(of_motor("zonotope", Params().set("strip", std::string("segment")), 20) > 1.5 * intervals);
}

TEST_CASE(
    "a larger budget is not worse by more than one percent in the mean over plants and seeds") {
  for (const std::string backend : {"zonotope", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(backend);
    std::array<double, 3> sums{};
    constexpr int plants = 16, seeds = 2;
    for (unsigned plant = 0; plant < plants; ++plant) {
      const Model model = random_plant(plant);
      const Index n = model.linear.states();
      for (unsigned seed = 1; seed <= seeds; ++seed) {
        double first = 0;
        for (const Index i : {0, 1, 2}) {
          Params budget = budget_of((Index{4} << i) * n);
          if (backend != "zonotope") budget.set("max_constraints", std::int64_t{4} << i);
          const double radius = mean_radius(model, backend, {}, budget, 60, seed);
          if (i == 0) first = radius;
          sums[static_cast<std::size_t>(i)] += radius / first / (plants * seeds);
        }
      }
    }
    CAPTURE(sums[1]);
    CAPTURE(sums[2]);
    CHECK(sums[1] <= 1.01);
    CHECK(sums[2] <= 1.01 * sums[1]);
  }
}
