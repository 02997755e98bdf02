// SPDX-License-Identifier: GPL-3.0-or-later
// Plants, their data and random runs for observers that lag.
#pragma once

#include <algorithm>
#include <limits>
#include <random>

#include "observers/exact_smoothing.hpp"
#include "published/comparison_models.hpp"

namespace smoothing {

using namespace cordon;
using namespace comparison;

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr std::int64_t unlimited = 100'000;

inline const Plugins& plugins() {
  static const Plugins instance;
  return instance;
}

inline std::shared_ptr<Observer> observer(const std::string& name, const Model& model,
                                          const std::string& backend, Index lag,
                                          std::int64_t generators = unlimited,
                                          std::int64_t constraints = unlimited) {
  Params params;
  params.set("max_generators", generators).set("max_constraints", constraints);
  if (lag > 0) params.set("lag", std::int64_t{lag});
  auto made = plugins().observer(name, model, plugins().backend(backend), params);
  made->start();
  return made;
}

inline std::vector<Sample> samples_of_three_states() {
  std::vector<Sample> all;
  for (std::size_t k = 0; k < input.size(); ++k) {
    all.push_back(
        {static_cast<Index>(k), Vector{{input[k]}}, Vector{{first_output[k], second_output[k]}}});
  }
  return all;
}

struct PlantData {
  Model model;
  std::vector<Sample> data;
  const std::vector<Bounds>& expected;
};

inline std::vector<PlantData> plants() {
  std::vector<PlantData> all{{comparison::two_states(), samples("observer_2dim", 2), of_two_states},
                             {comparison::vehicle(), samples("observer_vehicle", 1), of_vehicle},
                             {three_states(), samples_of_three_states(), of_three_states}};
  return all;
}

inline double distance(const Box& X, const Box& Y) {
  return std::max((X.lower - Y.lower).cwiseAbs().maxCoeff(),
                  (X.upper - Y.upper).cwiseAbs().maxCoeff());
}

/// A run of the model from a point of its X0; noise and disturbance at vertices or inside.
struct Trajectory {
  std::vector<Sample> data;
  std::vector<Vector> truth;
};

inline Trajectory simulated(const Model& model, Index steps, unsigned seed, bool vertices,
                            bool gaps) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto point = [&](const LineForm& X) {
    Vector factors(X.generators());
    for (double& factor : factors) {
      factor = uniform(random);
      if (vertices) factor = factor < 0 ? -1 : 1;
    }
    return Vector(X.c + X.G * factors);
  };
  const LinearModel& m = model.linear;
  Trajectory run;
  Vector x = point(model.X0);
  for (Index k = 0; k < steps; ++k) {
    Vector u(m.inputs());
    for (double& one : u) one = uniform(random);
    Sample sample{k, u, m.C * x + m.D * u + m.Dv * point(model.V)};
    for (Index i = 0; gaps && i < m.outputs(); ++i) {
      if (uniform(random) < .3) continue;
      sample.y[i] = nan;
      sample.missing.push_back(i);
    }
    run.data.push_back(std::move(sample));
    run.truth.push_back(x);
    x = m.A * x + m.B * u + m.Bw * point(model.W);
  }
  return run;
}

inline Model random_model(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto matrix = [&](Index rows, Index cols) {
    return Matrix::NullaryExpr(rows, cols, [&] { return uniform(random); }).eval();
  };
  const Index n = 1 + seed % 4, p = 1 + seed % 2;
  Model model;
  LinearModel& m = model.linear;
  m.A = matrix(n, n);
  m.B = matrix(n, 1);
  m.Bw = .1 * matrix(n, 2);
  m.C = matrix(p, n);
  m.D = matrix(p, 1);
  m.Dv = .1 * matrix(p, p);
  model.X0 = make_box(cube(n, 1));
  model.W = make_box(cube(2, 1));
  model.V = make_box(cube(p, 1));
  return model;
}

inline Sample without_outputs(Sample sample) {
  sample.missing.clear();
  for (Index i = 0; i < sample.y.size(); ++i) {
    sample.y[i] = nan;
    sample.missing.push_back(i);
  }
  return sample;
}

}  // namespace smoothing
