// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/box_solver.hpp"

#include <cmath>

#include "cordon/core/linalg.hpp"
#include "cordon/solvers/lp.hpp"

namespace cordon {

namespace {

/// Coefficients below this share of their row are left out: proposals need no more, and pivots on
/// noise are bad ones.
constexpr double noise = 1e-13;
constexpr Index some_rows = 40,
                many_rows =
                    100;  ///< from which on simplex iterations are counted, and not tried first
constexpr Index long_way = 4;  ///< as many iterations per row

/// The power of two that brings the largest entry into [1, 2).
int power_of(VectorIn g) {
  const double largest = g.size() ? g.cwiseAbs().maxCoeff() : 0;
  return largest > 0 && std::isfinite(largest) ? std::ilogb(largest) : 0;
}

void shift(Vector& v, int power) {
  if (power == 0) return;
  if (std::abs(power) < 1000) {
    v *= std::ldexp(1.0, power);
  } else {
    for (double& x : v) x = std::ldexp(x, power);
  }
}

}  // namespace

BoxSolver::Scaled::Scaled(const Matrix& whole)
    : scale(linalg::row_scales(whole)), A(whole.rows(), whole.cols()) {
  active.reserve(static_cast<std::size_t>(whole.cols()));
  for (Index j = 0; j < whole.cols(); ++j) {
    const Index k = static_cast<Index>(active.size());
    bool enters = false;
    for (Index i = 0; i < whole.rows(); ++i) {
      const double entry = scale[i] * whole(i, j);  // the largest of a row lies in [1, 2)
      A(i, k) = std::abs(entry) < noise ? 0.0 : entry;
      enters = enters || A(i, k) != 0;
    }
    if (enters || (active.empty() && j + 1 == whole.cols()))
      active.push_back(j);  // solvers want one variable at least
  }
  A.conservativeResize(Eigen::NoChange, static_cast<Index>(active.size()));
}

BoxSolver::BoxSolver(const Matrix& A, const Vector& b) : BoxSolver(Scaled(A), b, A.cols()) {}

BoxSolver::BoxSolver(Scaled rows, const Vector& b, Index cols)
    : rows_(std::move(rows)),
      b_(rows_.scale.cwiseProduct(b)),
      simplex_(rows_.A, b_),
      bounds_(cols) {}

/// `objective_`: of the active variables, with its largest entry in [1, 2).
void BoxSolver::take_objective(VectorIn g) {
  objective_.resize(static_cast<Index>(rows_.active.size()));
  idle_ = 0;
  for (Index j = 0, k = 0; j < g.size(); ++j) {
    bounds_[j] = g[j] < 0 ? -1 : 1;
    if (k < objective_.size() && rows_.active[static_cast<std::size_t>(k)] == j) {
      objective_[k++] = g[j];
    } else {
      idle_ += std::abs(g[j]);
    }
  }
  power_ = power_of(objective_);
  shift(objective_, -power_);
}

/// For `objective_`, with the solution in `simplex_`, or in `interior_` and `point_`.
BoxSolver::Status BoxSolver::solve(double enough) {
  const Index rows = rows_.A.rows();
  if (rows >= many_rows) return solve_from_inside(enough);
  if (!guess_) guess_.emplace(rows_.A, b_);
  if (rows < some_rows) return simplex_.maximize(objective_, guess_->scores(objective_), enough);
  const Status status =
      simplex_.maximize(objective_, guess_->scores(objective_), enough, long_way * rows);
  return status == Status::unsolved ? solve_from_inside(enough) : status;
}

BoxSolver::Status BoxSolver::solve_from_inside(double enough) {
  if (!interior_) interior_.emplace(rows_.A, b_);
  if (!interior_->maximize(objective_)) {
    if (!guess_) guess_.emplace(rows_.A, b_);
    return simplex_.maximize(objective_, guess_->scores(objective_), enough);
  }
  const Index few = 20 + rows_.A.rows() / 4;
  const Status status = simplex_.maximize(objective_, interior_->scores(), enough, few);
  if (status != Status::unsolved) return status;
  point_ = interior_->point();
  return Status::optimal;
}

BoxSolver::Status BoxSolver::maximize(VectorIn g, double enough) {
  take_objective(g);
  point_.reset();
  const Status status = solve(std::ldexp(enough - idle_, -power_));
  if (status == Status::unsolved) return second_opinion(g);
  value_ = std::ldexp(point_ ? interior_->value() : simplex_.objective(), power_) + idle_;
  y_ = point_ ? VectorIn(interior_->multipliers()) : simplex_.multipliers();
  if (status != Status::infeasible) shift(y_, power_);
  y_.array() *= rows_.scale.array();
  return status;
}

BoxSolver::Status BoxSolver::second_opinion(VectorIn g) {
  take_objective(g);
  constexpr int larger =
      8;  // GLPK's tolerances are absolute: whatever the objective is, it sees one of some hundreds
  shift(objective_, larger);
  const Vector one = Vector::Ones(objective_.size());
  LinearProgram::Solution solution = LinearProgram(rows_.A, b_, -one, one).maximize(objective_);
  if (solution.status != LinearProgram::Status::optimal) return Status::unsolved;
  value_ = std::ldexp(solution.objective, power_ - larger) + idle_;
  point_ = std::move(solution.x);
  y_ = std::move(solution.y);
  shift(y_, power_ - larger);
  y_.array() *= rows_.scale.array();
  return Status::optimal;
}

void BoxSolver::take_point(Vector& xi) {
  Vector point;
  if (point_) {
    point = *point_;
  } else {
    simplex_.take_point(point);
  }
  xi = bounds_;
  for (Index k = 0; k < point.size(); ++k) xi[rows_.active[static_cast<std::size_t>(k)]] = point[k];
}

}  // namespace cordon
