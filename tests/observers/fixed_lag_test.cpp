// SPDX-License-Identifier: GPL-3.0-or-later
// Estimates of earlier times by later samples are those of an independent computation, hold the
// truth, and are the filter's where nothing was sampled.
#include <algorithm>
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "observers/smoothing.hpp"

using namespace cordon;
using namespace smoothing;

namespace {

Vector of(const std::vector<double>& v) {
  return Eigen::Map<const Vector>(v.data(), static_cast<Index>(v.size()));
}

void expect_exact_bounds(const PlantData& plant, const std::string& backend, Index lag) {
  const auto smoother = observer("fixed_lag", plant.model, backend, lag);
  std::size_t found = 0, wanted = 0;
  Index last = 0;
  for (const Bounds& b : plant.expected) {
    if (b.lag != lag) continue;
    ++wanted;
    last = std::max<Index>(last, b.k);
  }
  for (const Sample& sample : plant.data) {
    if (sample.k > last + lag) break;
    const Estimate estimate = smoother->step(sample);
    CHECK(estimate.k == std::max<Index>(sample.k - lag, 0));
    CHECK(estimate.set.tightness == Tightness::exact);
    for (const Bounds& b : plant.expected) {
      if (b.lag != lag || b.k != estimate.k || sample.k - estimate.k != lag) continue;
      CAPTURE(b.k);
      CHECK(distance(estimate.set->interval_hull(), {of(b.lower), of(b.upper)}) <= 1e-7);
      ++found;
    }
  }
  CHECK(found == wanted);
  CHECK(found > 0);
}

void expect_truth_inside(const Model& model, const Trajectory& run, const std::string& backend,
                         Index lag, std::int64_t generators, std::int64_t constraints) {
  const auto smoother = observer("fixed_lag", model, backend, lag, generators, constraints);
  for (const Sample& sample : run.data) {
    const Estimate estimate = smoother->step(sample);
    const Vector& x = run.truth[static_cast<std::size_t>(estimate.k)];
    CAPTURE(sample.k);
    CHECK(estimate.consistent != Answer::no);
    const Box hull = estimate.set->interval_hull();
    const Vector room = Vector::Constant(x.size(), 1e-9 * std::max(1.0, x.cwiseAbs().maxCoeff()));
    CHECK(((x - hull.lower + room).array() >= 0).all());
    CHECK(((hull.upper - x + room).array() >= 0).all());
  }
}

}  // namespace

TEST_CASE("unreduced constrained zonotopes are all states that later samples leave") {
  for (const PlantData& plant : plants()) {
    CAPTURE(plant.model.states());
    for (const Index lag : {1, 2, 5}) {
      CAPTURE(lag);
      expect_exact_bounds(plant, "constrained_zonotope", lag);
    }
  }
  const PlantData plant = plants()[2];
  expect_exact_bounds({plant.model, {plant.data.begin(), plant.data.begin() + 26}, plant.expected},
                      "line_zonotope", 2);
}

TEST_CASE("estimates hold the truth, whatever their budgets are, with gaps too") {
  struct Choice {
    const char* backend;
    std::int64_t generators, constraints;
  };
  std::vector<Model> models;
  for (const PlantData& plant : plants()) models.push_back(plant.model);
  for (unsigned seed = 0; seed < 12; ++seed) models.push_back(random_model(seed));
  for (const Choice& choice :
       {Choice{"constrained_zonotope", 20, 5}, Choice{"line_zonotope", 20, 3},
        Choice{"zonotope", 20, 0}, Choice{"interval", 20, 0}}) {
    CAPTURE(choice.backend);
    for (std::size_t i = 0; i < models.size(); ++i) {
      CAPTURE(i);
      for (unsigned seed = 1; seed <= 4; ++seed) {
        CAPTURE(seed);
        const Trajectory run = simulated(models[i], 30, seed, seed % 2 == 0, seed > 2);
        expect_truth_inside(models[i], run, choice.backend, 1 + seed % 4, choice.generators,
                            choice.constraints);
      }
    }
  }
}

TEST_CASE("samples without outputs say nothing: the estimate is that of the filter") {
  constexpr Index lag = 3;
  for (const PlantData& plant : plants()) {
    for (const Index k : {0, 1, 4, 9}) {
      const auto smoother = observer("fixed_lag", plant.model, "constrained_zonotope", lag),
                 filter = observer("prediction_correction", plant.model, "constrained_zonotope", 0);
      Estimate late, filtered;
      for (const Sample& sample : plant.data) {
        if (sample.k > k + lag) break;
        late = smoother->step(sample.k <= k ? sample : without_outputs(sample));
        if (sample.k <= k) filtered = filter->step(sample);
      }
      CHECK(late.k == k);
      CHECK(filtered.k == k);
      CHECK(distance(late.set->interval_hull(), filtered.set->interval_hull()) <= 1e-9);
    }
  }
}

TEST_CASE("intervals know nothing between times: they are those of the filter, late") {
  const PlantData plant = plants()[2];
  const auto smoother = observer("fixed_lag", plant.model, "interval", 4),
             filter = observer("prediction_correction", plant.model, "interval", 0);
  std::vector<Box> filtered;
  for (const Sample& sample : plant.data) {
    filtered.push_back(filter->step(sample).set->interval_hull());
    const Estimate late = smoother->step(sample);
    CHECK(distance(late.set->interval_hull(), filtered[static_cast<std::size_t>(late.k)]) <= 1e-12);
  }
}

TEST_CASE("a reduced estimate encloses the exact one, and does not claim to be it") {
  const PlantData plant = plants()[2];
  const auto exact = observer("fixed_lag", plant.model, "constrained_zonotope", 2),
             reduced = observer("fixed_lag", plant.model, "constrained_zonotope", 2, 20, 5);
  for (const Sample& sample : plant.data) {
    if (sample.k > 20) break;
    const Estimate X = exact->step(sample), Y = reduced->step(sample);
    const Box inner = X.set->interval_hull(), outer = Y.set->interval_hull();
    CHECK(((inner.lower - outer.lower).array() >= -1e-9).all());
    CHECK(((outer.upper - inner.upper).array() >= -1e-9).all());
    if (sample.k > 10) CHECK(Y.set.tightness == Tightness::outer);
  }
}

TEST_CASE("effectiveness and matrices known by ranges: the truth stays inside") {
  Model model = three_states();
  LinearModel& m = model.linear;
  m.A_radius = Matrix{{.02, 0, 0}, {0, .03, 0}, {.01, 0, 0}};
  m.C_radius = Matrix{{.05, 0, 0}, {0, .02, 0}};
  m.actuator = {Vector{{.7}}, Vector{{1}}};
  for (const char* backend : {"constrained_zonotope", "zonotope", "interval"}) {
    CAPTURE(backend);
    for (unsigned seed = 1; seed <= 6; ++seed) {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> uniform(-1, 1);
      const auto drawn = [&](const Matrix& A, const Matrix& radius) {
        return Matrix(A + radius.unaryExpr([&](double r) { return r * uniform(random); }));
      };
      Trajectory run;
      Vector x{{.5, -.5, 1}};
      for (Index k = 0; k < 25; ++k) {
        const Vector u{{uniform(random)}}, w{{uniform(random), uniform(random)}},
            v{{uniform(random), uniform(random)}};
        run.truth.push_back(x);
        run.data.push_back({k, u, drawn(m.C, m.C_radius) * x + m.Dv * v});
        x = drawn(m.A, m.A_radius) * x + (.85 + .15 * uniform(random)) * m.B * u + m.Bw * w;
      }
      expect_truth_inside(model, run, backend, 2, 30, 8);
    }
  }
}
