// SPDX-License-Identifier: GPL-3.0-or-later
// The backend `polytope` against the exact sets of the check, and other backends against both: the
// plant of examples/studies/linear_two_states.json over 100 steps. Support values are equal to the
// last bit with rational numbers, and with `"digits": 0` up to 1e-13 of the set's coordinates.
#include <random>

#include <doctest/doctest.h>

#include "published/study_models.hpp"
#include "study/verification/feasible_set.hpp"

using namespace cordon;

namespace {

Model two_states() {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{0, -.5}, {1, 1}};
  m.B = Matrix(2, 0);
  m.Bw = Matrix{{-.12}, {.02}};
  m.C = Matrix{{-2, 1}};
  m.D = Matrix(1, 0);
  m.Dv = Matrix{{.2}};
  model.X0 = make_box(cube(2, 3));
  model.W = model.V = make_box(cube(1, 1));
  model.U = make_space(0);
  return model;
}

std::vector<Sample> simulated(const Model& model, Index steps, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto noise = [&] { return Vector(Vector{{number(engine)}}); };
  const LinearModel& m = model.linear;
  std::vector<Sample> samples;
  Vector x{{1, -1}};
  for (Index k = 0; k <= steps; ++k) {
    samples.push_back({k, Vector(0), m.C * x + m.Dv * noise()});
    x = (m.A * x + m.Bw * noise()).eval();
  }
  return samples;
}

const std::vector<Vector> fixed{Vector{{1, 0}},  Vector{{0, 1}},   Vector{{-1, 0}},
                                Vector{{0, -1}}, Vector{{1, 1}},   Vector{{-2, 1}},
                                Vector{{.3, 1}}, Vector{{-1, -.7}}};

}  // namespace

TEST_CASE("polytopes are the exact sets, and no other representation is tighter") {
  const Plugins plugins;
  const Model model = two_states();
  struct Followed {
    std::string name;
    Params params;
    std::shared_ptr<Observer> observer;
  };
  std::vector<Followed> all;
  const auto add = [&](const std::string& name, Params params) {
    Params budget;
    budget.set("max_generators", std::int64_t{40}).set("max_constraints", std::int64_t{20});
    all.push_back(
        {name, params,
         plugins.observer("prediction_correction", model, plugins.backend(name, params), budget)});
  };
  add("polytope", Params());
  add("polytope", Params().set("digits", std::int64_t{0}));
  for (const char* name :
       {"line_zonotope", "constrained_zonotope", "zonotope", "ellipsoid", "interval"})
    add(name, Params().set("rounding", std::string("outward")));

  verification::FeasibleSets sets(model, model.X0, std::nullopt);
  for (const Sample& sample : simulated(model, 100, 1)) {
    CAPTURE(sample.k);
    const Polytope F = sets.step(sample);
    std::vector<Vector> directions = fixed;
    const Matrix facets = F.inequalities().H;  // rounded: next to the facets of both
    for (Index i = 0; i < facets.rows(); ++i) directions.emplace_back(facets.row(i).transpose());
    for (std::size_t i = 0; i < all.size(); ++i) {
      CAPTURE(all[i].name);
      CAPTURE(i);
      const Estimate estimate = all[i].observer->step(sample);
      if (i == 0) CHECK(estimate.set.tightness == Tightness::exact);
      const double size = F.interval_hull().upper.cwiseAbs().maxCoeff() + 1;
      for (const Vector& d : directions) {
        const Interval h = F.support(d);
        const double found = estimate.set->support(d);
        CHECK(found >= h.upper);
        if (i == 0) CHECK(found == h.upper);
        if (i == 1) CHECK(found <= h.upper + 1e-13 * size);
      }
    }
  }
}
