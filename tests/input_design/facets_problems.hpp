// SPDX-License-Identifier: GPL-3.0-or-later
// Problems of input design for the search over facets.
#pragma once

#include <random>

#include "designers/facets/first_input.hpp"
#include "designers/facets/forbidden_set.hpp"
#include "designers/facets/search.hpp"
#include "input_design/plugins.hpp"
#include "input_design/systems.hpp"

namespace cordon::examples {

using designers::Cost;
using designers::InputSequences;
using designers::SeparationProblem;

/// All inputs within ±radius but the first `fixed` ones, which are 0.
inline InputSequences boxed_inputs(Index n, double radius, Index fixed = 0) {
  InputSequences U{Vector::Zero(n), Matrix::Zero(n, n - fixed), Matrix(0, n - fixed), Vector(0)};
  U.G.bottomRows(n - fixed) = radius * Matrix::Identity(n - fixed, n - fixed);
  return U;
}

inline SeparationProblem problem_of(std::vector<PairProgram> pairs, InputSequences U,
                                    Cost::Kind kind, double epsilon) {
  SeparationProblem problem;
  const Index n = U.c.size();
  problem.inputs = n;
  problem.pairs = std::move(pairs);
  problem.U = std::move(U);
  problem.cost = {kind, Vector::Ones(n), Vector::Zero(n)};
  problem.epsilon = epsilon;
  return problem;
}

inline PairProgram pair_of(Index i, Index j, const Matrix& G, const Vector& c, const Matrix& N) {
  return {i, j, G, c, N, Vector::Zero(c.size())};
}

/// Section 6.2 with u_0 = (.5, -1), |u| ≤ 8 and that reference.
inline SeparationProblem published_problem(Index horizon, double epsilon,
                                           Cost::Kind kind = Cost::Kind::norm_1) {
  std::vector<OutputTube> tubes;
  SeparationProblem problem;
  problem.horizon = horizon;
  problem.inputs = 2;
  for (const Mode& mode : four_descriptor_models().modes) {
    tubes.push_back(output_tube(mode.model, *backend("line_zonotope"), {horizon}));
    problem.conditions.push_back(conditions_of(tubes.back()));
  }
  problem.pairs = pair_programs(tubes);
  const Index n = 2 * (horizon + 1);
  problem.cost = {kind, Vector::Ones(n), numbers({.5, -1}).replicate(horizon + 1, 1)};
  problem.U = boxed_inputs(n, 8, 2);
  problem.U.c.head(2) = numbers({.5, -1});
  problem.epsilon = epsilon;
  return problem;
}

inline SeparationProblem scalar_problem(double epsilon) {
  std::vector<OutputTube> tubes;
  for (const Mode& mode : three_scalar_models().modes) {
    tubes.push_back(output_tube(mode.model, *backend("line_zonotope"), {3}));
  }
  return problem_of(pair_programs(tubes), boxed_inputs(4, 2), Cost::Kind::norm_1, epsilon);
}

inline Matrix random_matrix(std::mt19937& random, Index rows, Index cols) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Matrix::NullaryExpr(rows, cols, [&] { return uniform(random); });
}

/// m rows, g generators, rank r in the inputs; u of size 1 about reaches the boundary of what does
/// not separate.
inline PairProgram random_pair(std::mt19937& random, Index i, Index j, Index m, Index g, Index r,
                               Index inputs) {
  const Matrix N = random_matrix(random, m, r) * random_matrix(random, r, inputs);
  return pair_of(i, j, random_matrix(random, m, g) / static_cast<double>(g),
                 .1 * random_matrix(random, m, 1), N);
}

/// The search over facets alone, from a first input.
inline designers::SearchResult searched(const SeparationProblem& problem,
                                        const designers::FacetLimits& limits,
                                        DesignControl& control) {
  designers::NodeProgram program(problem);
  const designers::Watch early(control, problem.horizon, .05 * limits.time_limit);
  const designers::KnownAnswer first =
      designers::first_input(problem, program, [&] { return early.over(); });
  return designers::search_facets(problem, limits, first, control);
}
inline designers::SearchResult searched(const SeparationProblem& problem,
                                        const designers::FacetLimits& limits = {}) {
  DesignControl control;
  return searched(problem, limits, control);
}

inline designers::ForbiddenSet forbidden(const PairProgram& pair, const InputSequences& U,
                                         double epsilon) {
  DesignControl control;
  return designers::forbidden_set(pair, U, epsilon, 10000, designers::Watch(control, 0, 60));
}

}  // namespace cordon::examples
