// SPDX-License-Identifier: GPL-3.0-or-later
// The optimisation problem that designers solve at one horizon, and what they answer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cordon/tubes/separation.hpp"

namespace cordon::designers {

/// Cost of an input sequence u = (u_0, …, u_N), stacked, with weights ω ≥ 0 and reference r:
///   norm_1    Σ ω_i |u_i - r_i|,   norm_inf  max ω_i |u_i - r_i|,   quadratic  Σ ω_i (u_i - r_i)²
struct Cost {
  enum class Kind { norm_1, norm_inf, quadratic };
  Kind kind = Kind::norm_1;
  Vector weights, reference;
  double at(VectorIn u) const;
};

/// A stacked sequence, a row per time, and back.
Matrix by_time(VectorIn u, Index inputs);
Vector stacked(const Matrix& u);

/// U = {c + G ξ : A ξ = b, ‖ξ‖∞ ≤ 1}: bounded, all sequences that may be applied, a fixed u_0
/// included.
struct InputSequences {
  Vector c;
  Matrix G, A;
  Vector b;
};

/// min cost(u) over u ∈ U with κ_q(u) ≥ ε for every pair q, and no tube empty.
struct SeparationProblem {
  Index horizon = 0, inputs = 0;  ///< N and n_u: u has n_u (N+1) entries
  std::vector<PairProgram> pairs;
  std::vector<TubeConditions> conditions;  ///< of every mode; most often without rows
  InputSequences U;
  Cost cost;
  double epsilon = 0;
  std::vector<std::string> modes = {};  ///< their names, for reasons
  std::optional<Vector> start = {};     ///< an input of U that leaves no tube empty, to begin with
};
/// The modes of a pair, for people: by their names, or by numbers from 1 where these are not given.
std::string modes_of(const SeparationProblem& problem, const PairProgram& pair);

/// What a search found. A lower bound is one of all feasible u; nothing here rests on a solver's
/// status alone.
struct SearchResult {
  DesignStatus status = DesignStatus::unknown;
  std::optional<Vector> u;
  double cost = 0, lower_bound = -infinity;
  std::optional<RestrictedProblem> restriction = {};  ///< as in DesignOutcome
  bool stopped = false;
  std::string reason = {}, suggestion = {};
  std::int64_t nodes = 0, programs = 0, facets = 0;
};

}  // namespace cordon::designers
