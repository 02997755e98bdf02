// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of a plant apart from the product's own simulation, and random plants.
#pragma once

#include <limits>

#include "cordon/core/line_form.hpp"
#include "cordon/interfaces/backend.hpp"
#include "cordon/interfaces/model.hpp"
#include "cordon/sets/sampling.hpp"

namespace noisy_runs {

using namespace cordon;

/// x_0 ∈ X0 and w, v in their sets, uniform or at vertices of the generators' cubes.
class Run {
 public:
  Run(const Model& model, std::uint64_t seed, bool vertices)
      : model_(model), random_(seed), vertices_(vertices), x(from(model.X0)) {}

  Vector from(const LineForm& X) {
    Vector xi = random_.cube(X.generators());
    if (vertices_) xi = xi.unaryExpr([](double a) { return a < 0 ? -1. : 1.; });
    return X.c + X.G * xi;
  }
  Sample sample(Index k) {
    const LinearModel& m = model_.linear;
    const Vector u = random_.cube(m.inputs());
    Sample now{k, u, m.C * x + m.D * u + m.Dv * from(model_.V)};
    next_ = m.A * x + m.B * u + m.Bw * from(model_.W);
    return now;
  }
  void move_on() { x = next_; }
  double unit() { return random_.unit(); }

 private:
  const Model& model_;
  sets::Random random_;
  bool vertices_;
  Vector next_;

 public:
  Vector x;
};

inline Sample with_gaps(Sample sample, Run& run) {
  for (Index i = 0; i < sample.y.size(); ++i) {
    if (run.unit() > .3) continue;
    sample.y[i] = std::numeric_limits<double>::quiet_NaN();
    sample.missing.push_back(i);
  }
  return sample;
}

inline bool holds(const Enclosure& X, const Vector& x) {
  const Vector slack = Vector::Constant(x.size(), 1e-9 * (1 + x.cwiseAbs().maxCoeff()));
  const Box hull = X->interval_hull();
  if (((x - slack).array() > hull.upper.array()).any()) return false;
  if (((x + slack).array() < hull.lower.array()).any()) return false;
  return X->is_disjoint_from(*X->backend().box({x - slack, x + slack})) != Answer::yes;
}

inline Model random_model(std::uint64_t seed) {
  sets::Random random(seed);
  const auto matrix = [&](Index rows, Index cols, double size) {
    return Matrix(Matrix::NullaryExpr(rows, cols, [&] { return random.between(-size, size); }));
  };
  const Index n = 1 + static_cast<Index>(seed % 4), p = 1 + static_cast<Index>(seed % 3);
  Model model;
  LinearModel& m = model.linear;
  m.A = matrix(n, n, .8);
  m.B = matrix(n, 2, 1);
  m.C = matrix(p, n, 1);
  m.D = matrix(p, 2, 1);
  m.Bw = matrix(n, 2, .2);
  m.Dv = matrix(p, 2, .3);
  model.X0 = make_zonotope(Vector::Constant(n, 3), matrix(n, n + 1, 1));
  model.W = make_zonotope(Vector{{.3, -.2}}, matrix(2, 3, .5));
  model.V = make_zonotope(Vector{{-.5, .1}}, matrix(2, 3, .5));
  return model;
}

}  // namespace noisy_runs
