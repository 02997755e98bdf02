// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>

#include "cordon/formulas/evaluator.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"

namespace cordon::test {

/// A trajectory of the formulas: disturbances and noises are drawn, half of them at vertices.
class Trajectory {
 public:
  Trajectory(const Model& model, std::uint64_t seed)
      : model_(model),
        f_(model.nonlinear->f, Rounding::nominal),
        g_(model.nonlinear->g, Rounding::nominal),
        random_(seed),
        x_(point_of(model.X0)) {}

  const Vector& x() const { return x_; }
  Vector output(VectorIn u, Index k) {
    return values(g_, point_of(model_.V), u, k).head(model_.outputs());
  }
  void advance(VectorIn u, Index k) { x_ = values(f_, point_of(model_.W), u, k); }

 private:
  Vector point_of(const LineForm& set) {
    Vector factors(set.G.cols());
    const bool at_vertex = std::bernoulli_distribution(0.5)(random_);
    for (double& factor : factors) {
      factor = std::uniform_real_distribution<double>(-1, 1)(random_);
      if (at_vertex) factor = factor < 0 ? -1 : 1;
    }
    return set.c + set.G * factors;
  }
  Vector values(formulas::Evaluator& evaluator, const Vector& noise, VectorIn u, Index k) {
    std::vector<Interval> point;
    for (const double known : x_) point.push_back({known, known});
    for (const double known : noise) point.push_back({known, known});
    for (const double known : u) point.push_back({known, known});
    point.push_back({static_cast<double>(k), static_cast<double>(k)});
    evaluator.evaluate(point);
    Vector made(evaluator.function().rows());
    for (Index row = 0; row < made.size(); ++row) {
      const Interval value = evaluator.value(row);
      made[row] = 0.5 * value.lower + 0.5 * value.upper;
    }
    return made;
  }

  Model model_;
  formulas::Evaluator f_, g_;
  std::mt19937_64 random_;
  Vector x_;
};

}  // namespace cordon::test
