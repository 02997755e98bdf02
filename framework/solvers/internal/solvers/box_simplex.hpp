// SPDX-License-Identifier: GPL-3.0-or-later
// A dual simplex method for the linear program of this field: few rows, all variables in [-1,1].
#pragma once

#include <limits>
#include <vector>

#include "cordon/core/types.hpp"
#include "solvers/panels.hpp"

namespace cordon {

/// max{gᵀξ : Aξ = b, ‖ξ‖∞ ≤ 1} by proposals: y and ξ are computed in doubles; what they prove is
/// for others to say.
///
/// Dual simplex method with bound flipping. Boxed variables make every basis dual feasible, so
/// there is no first phase. Each row has an artificial variable in [0,0]: the first basis, which is
/// never singular; once out, an artificial never returns, and redundant rows keep theirs. Where the
/// bound does not move any more, costs are changed by some 1e-6 until the basis is optimal under
/// these. The inverse of the basis is kept explicitly, by columns; the squared norms of its rows
/// (exact steepest edges, [Forrest1992]) fall out of its update. Sums have one order on every
/// machine. Nothing is allocated after construction. Tolerances are absolute: rows and objective
/// should have entries of about 1. O(m (m + g)) per iteration.
class BoxSimplex {
 public:
  BoxSimplex(const Matrix& A, VectorIn b);

  enum class Status {
    optimal,     ///< `multipliers` and `point` are optimal up to rounding
    infeasible,  ///< `multipliers` are a Farkas vector up to rounding: bᵀy > ‖Aᵀy‖₁
    below,       ///< `multipliers` show, up to rounding, that the maximum is below what was enough
    unsolved     ///< no claim: numerical trouble, or too many iterations
  };
  static constexpr double any = -infinity;

  /// The first basis consists of the columns with the smallest scores, as far as they are
  /// independent. Ends early once the maximum is known to be < enough, and unsolved after `most`
  /// iterations.
  Status maximize(VectorIn g, VectorIn scores, double enough = any,
                  Index most = std::numeric_limits<Index>::max());

  VectorIn multipliers() const { return y_.head(m_); }
  /// gᵀξ of the last basic solution.
  double objective() const;
  /// The last basic solution: satisfies the rows up to rounding; the bounds too if optimal. O(m (m
  /// + g)).
  void take_point(Vector& xi);
  Index iterations() const { return iterations_; }

 private:
  static constexpr Index none = -1;
  bool is_artificial(Index variable) const { return variable >= g_; }
  Index basic(Index row) const { return basic_[static_cast<std::size_t>(row)]; }
  double room(Index row) const { return is_artificial(basic(row)) ? 0 : 1; }

  void order_by(VectorIn scores);
  void build_basis();
  bool bring_in(Index variable);
  bool take_objective();
  void solve_basics();
  void refine_basics();
  void find_multipliers();
  void refine_multipliers();
  bool rebuild();
  void transform(const double* v, Vector& image) const;
  void update_inverse(Index row);
  void perturb_costs();
  bool take_back_perturbations();
  Status concluded(Status status);
  Status solve(double enough, Index most);
  Index leaving_row() const;
  void price(Index row);
  Index entering_variable(double infeasibility);
  void select(std::size_t place);
  void flip_passed();
  bool exchange(Index row, Index entering);

  Index m_, g_, height_;  ///< rows, columns, rows with padding
  Matrix columns_, inverse_;
  Panels<double> panels_;  ///< the columns once more
  std::vector<double> sums_;
  Vector b_, objective_, y_, basic_value_, norms_, rho_, image_, change_, change_image_;
  std::vector<Index> basic_;  ///< variable in each position; artificial i is g + i
  std::vector<Index> order_;  ///< columns, those to be made basic first
  std::vector<Index>
      candidates_;  ///< variables whose reduced costs fall; those that were passed come first
  std::vector<double> steps_;  ///< of the multipliers, where these costs vanish
  /// Of the structural variables, with padding: objective; bound ±1, 0 for basic ones; side ·
  /// reduced cost ≥ 0, its decrease per step of the multipliers.
  Vector cost_, side_, reduced_, decrease_;
  std::size_t candidate_count_ = 0, passed_ = 0;
  Index iterations_ = 0, updates_ = 0;
  bool perturbed_ = false;  ///< costs differ from the objective
  double direction_ =
      1;  ///< +1: the leaving variable is below its lower bound; -1: above its upper one
};

}  // namespace cordon
