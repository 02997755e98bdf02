// SPDX-License-Identifier: GPL-3.0-or-later
// Problems of input design and random pairs, without a designer around them.
#pragma once

#include "designers/separation_problem.hpp"
#include "input_design/plugins.hpp"
#include "input_design/systems.hpp"

namespace cordon::examples {

/// The 1-norm of all inputs, each in [-range, range] but the first ones that are fixed.
inline designers::SeparationProblem separation_problem(const ModeBank& bank, Index horizon,
                                                       double range, const Vector& reference,
                                                       const Vector& first_input) {
  std::vector<OutputTube> tubes;
  for (const Mode& mode : bank.modes)
    tubes.push_back(output_tube(mode.model, *backend("line_zonotope"), {horizon}));
  designers::SeparationProblem problem;
  problem.horizon = horizon;
  problem.inputs = bank[0].model.linear.inputs();
  problem.pairs = pair_programs(tubes);
  for (const OutputTube& tube : tubes) problem.conditions.push_back(conditions_of(tube));
  const Index n = problem.inputs * (horizon + 1), fixed = first_input.size();
  problem.U = {Vector::Zero(n), Matrix::Zero(n, n - fixed), Matrix(0, n - fixed), Vector(0)};
  problem.U.c.head(fixed) = first_input;
  problem.U.G.bottomRows(n - fixed).diagonal().setConstant(range);
  problem.cost = {designers::Cost::Kind::norm_1, Vector::Ones(n), reference};
  problem.epsilon = 1e-4;
  return problem;
}

inline designers::SeparationProblem descriptor_problem() {
  return separation_problem(four_descriptor_models(), 3, 8, reference_input(), numbers({.5, -1}));
}
inline designers::SeparationProblem scalar_problem() {
  return separation_problem(three_scalar_models(), 3, 2, Vector::Zero(4), Vector(0));
}

/// m rows and g ≥ m generators, which `inputs` inputs enter in `rank` dimensions.
inline PairProgram random_pair(std::mt19937& random, Index m, Index g, Index inputs, Index rank) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto matrix = [&](Index rows, Index cols) {
    return Matrix(Matrix::NullaryExpr(rows, cols, [&] { return uniform(random); }));
  };
  return {0,
          1,
          matrix(m, g),
          .1 * matrix(m, 1),
          3 * matrix(m, rank) * matrix(rank, inputs),
          Vector::Zero(m)};
}

inline Vector random_vector(std::mt19937& random, Index n, double range) {
  std::uniform_real_distribution<double> uniform(-range, range);
  return Vector::NullaryExpr(n, [&] { return uniform(random); });
}

}  // namespace cordon::examples
