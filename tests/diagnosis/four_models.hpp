// SPDX-License-Identifier: GPL-3.0-or-later
// The four descriptor models of [Rego2025, sec. 6.2] with their inputs, and their simulation.
#pragma once

#include <string>
#include <vector>

#include "cordon/sets/sampling.hpp"
#include "input_design/systems.hpp"
#include "published/study_models.hpp"

namespace diagnosis_test {

using namespace cordon;

inline ModeBank four_models() { return examples::four_descriptor_models(); }

/// u_0 … u_3, published: separates the four models at k = 3.
inline std::vector<Vector> separating_input() {
  return {Vector{{.5, -1}}, Vector{{-3.4399, -1}}, Vector{{1.0854, -7.0632}}, Vector{{.5, -1}}};
}
/// Published as the reference that separates none of them.
inline std::vector<Vector> reference_input() { return std::vector<Vector>(4, Vector{{.5, -1}}); }

struct Simulated {
  Sample sample;
  Vector state;
};

/// Samples of a model with E = diag(1, 1, 0) and A_33 = 1 whose third row is static. The initial
/// state is drawn from X0 such that the static row holds; disturbances uniform or at vertices of
/// their boxes.
inline std::vector<Simulated> simulate(const Model& model, const std::vector<Vector>& inputs,
                                       std::uint64_t seed, bool vertex) {
  const LinearModel& m = model.linear;
  sets::Random random(seed);
  const auto factors = [&](Index n, bool vertices) {
    Vector xi = random.cube(n);
    if (vertices) xi = (xi.array() < 0).select(Vector::Constant(n, -1), Vector::Ones(n)).eval();
    return xi;
  };
  const auto disturbance = [&](const LineForm& X) -> Vector {
    return X.c + X.G * factors(X.generators(), vertex);
  };
  const auto solve_static = [&](Vector x, const Vector& u, const Vector& w) {
    x[2] = 0;
    x[2] = -(m.A.row(2).dot(x) + m.B.row(2).dot(u) + m.Bw.row(2).dot(w));
    return x;
  };
  Vector w = disturbance(model.W);
  Vector x;
  int tries = 0;
  do {  // no vertex may meet the static row
    x = solve_static(model.X0.c + model.X0.G * factors(3, vertex && ++tries < 20), inputs[0], w);
  } while (std::abs(x[2] - model.X0.c[2]) > model.X0.G(2, 2));
  std::vector<Simulated> result;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    const Vector y = m.C * x + m.D * inputs[k] + m.Dv * disturbance(model.V);
    result.push_back({{static_cast<Index>(k), inputs[k], y}, x});
    if (k + 1 == inputs.size()) break;
    const Vector next = m.A * x + m.B * inputs[k] + m.Bw * w;
    w = disturbance(model.W);
    x = solve_static(next, inputs[k + 1], w);
  }
  return result;
}

}  // namespace diagnosis_test
