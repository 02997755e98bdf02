// SPDX-License-Identifier: GPL-3.0-or-later
// The linear program of a node: the cheapest input sequence beyond some facets.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "cordon/solvers/lp.hpp"
#include "designers/bounded_program.hpp"
#include "designers/facets/forbidden_set.hpp"

namespace cordon::designers {

/// min cost(c + Gζ) subject to ζ in U, no tube empty, and a·ζ ≥ out for the chosen facets. Every
/// bound is one for a·ζ ≥ in. Solutions keep a little inside of what leaves a tube non-empty, so
/// that this can be proven of them; bounds do not.
///   norm_1     u_i - r_i = σ_i (p_i - q_i), cost Σ ω_i σ_i (p_i + q_i)
///   norm_inf   T t ≥ ω_i |u_i - r_i|
///   quadratic  t_i ≥ 2 τ (u_i - r_i)/σ_i - τ² for tangents τ, cost Σ ω_i σ_i² t_i: cheaper than
///   the true cost. From what the
///              solution makes active follows the minimum of the true cost, and multipliers that
///              prove it with tangents there
/// with σ_i the largest possible |u_i - r_i|.
class NodeProgram {
 public:
  explicit NodeProgram(const SeparationProblem& problem);

  struct Answer {
    bool impossible = false;     ///< proven: there is no such input
    double bound = 0;            ///< proven lower bound of the cost, 0 if nothing better is proven
    std::optional<Vector> zeta;  ///< as the solver found it
    std::vector<double> multipliers;  ///< of the chosen facets, ≥ 0
  };
  /// For quadratic costs with tangents at `touched`, input sequences.
  Answer solve(const std::vector<const SeparatingFacet*>& chosen,
               const std::vector<Vector>& touched = {});

  /// Of the input sequences that go farthest in a direction of u, no tube empty, the cheapest (its
  /// ζ); nothing if there is no answer.
  std::optional<Vector> farthest(const Vector& direction);

  std::int64_t programs() const { return programs_; }

 private:
  void add_cost();
  void touch(BoundedProgram& program, Index i, double at) const;  ///< a tangent of t_i
  double in_cost(double value) const;
  void polish(const BoundedProgram& program, const std::vector<const SeparatingFacet*>& chosen,
              const Vector& x, Answer& answer);
  bool proven_impossible(const std::vector<const SeparatingFacet*>& chosen);
  LinearProgram inside(const BoundedProgram& program) const;

  const SeparationProblem& problem_;
  BoundedProgram hard_, full_;  ///< without and with the rows and columns of the cost; ζ are the
                                ///< first columns of both
  Vector reach_;                ///< σ
  std::vector<Index>
      column_;    ///< of p_i (q_i is the next) or t_i; -1: input i costs nothing or the same always
  Vector price_;  ///< of these columns
  double constant_ = 0, unit_ = 1;  ///< cost = constant + unit · costᵀx
  std::int64_t programs_ = 0;
};

}  // namespace cordon::designers
