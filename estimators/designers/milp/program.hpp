// SPDX-License-Identifier: GPL-3.0-or-later
// The mixed-integer linear program (37) of [Rego2025], built block by block.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "cordon/solvers/mip.hpp"
#include "designers/separation_problem.hpp"

namespace cordon::designers {

/// Coefficients of one row, by column.
using Terms = std::vector<std::pair<Index, double>>;

/// The inputs, their cost and the tubes that must not be empty:
///   u = c + G ξ_u, A ξ_u = b,  A ζ = b + Ω u for each tube,  ‖ξ_u‖∞, ‖ζ‖∞ ≤ 1,  t ≥ the parts of
///   the cost.
/// The columns of u come first. A quadratic cost is met by tangents, which are added where they are
/// needed.
class InputProgram {
 public:
  explicit InputProgram(const SeparationProblem& problem);

  const MixedIntegerProgram& program() const { return program_; }
  Index inputs() const { return inputs_; }
  Vector lower() const { return program_.lower.head(inputs_); }  ///< bounds of u
  Vector upper() const { return program_.upper.head(inputs_); }

  /// Bounds u to what costs at most `cost`.
  void limit_cost(double cost);
  /// Only inputs that cost at least `cost` are looked for: a bound that is known.
  void demand_cost(double cost);
  /// The tangent planes of ω(u - r)² at u, for a quadratic cost.
  void add_tangents(const Vector& u);
  /// At places spread over the bounds of u.
  void add_tangents_between();
  /// lower ≤ aᵀu ≤ upper.
  void add_row(const Vector& a, double lower, double upper);
  void add_row(const Terms& terms, double lower, double upper);
  /// The first of the new columns.
  Index add_columns(Index count, double lower, double upper, bool integer = false);

 private:
  void add_inputs(const InputSequences& U);
  void add_cost();
  void add_conditions(const TubeConditions& rows);

  Index inputs_, first_cost_ = 0, costs_ = 0;
  Cost cost_;
  MixedIntegerProgram program_;
};

/// The columns that say on which side of the box each factor of a pair is.
struct PairColumns {
  Index first = 0, generators = 0;  ///< p₁, then p₂
};

/// κ(u) ∈ [ε, κ_m] for one pair: with G ξ = N u - c, ‖ξ‖∞ ≤ 1 + κ, and multipliers λ, Gᵀλ = μ₁ -
/// μ₂, 1ᵀ(μ₁ + μ₂) = 1, which prove that κ is least, since factors with μ₁ > 0 are at the upper
/// bound 1 + κ, those with μ₂ > 0 at the lower.
PairColumns add_pair(InputProgram& inputs, const PairProgram& pair, double epsilon,
                     double kappa_most);

}  // namespace cordon::designers
