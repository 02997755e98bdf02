// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/box_solver.hpp"

#include <cmath>

#include "cordon/core/linalg.hpp"
#include "cordon/solvers/lp.hpp"

namespace cordon {

namespace {

/// Coefficients below this share of their row are left out: proposals need no more, and pivots on noise are bad ones.
constexpr double noise = 1e-13;

Matrix scaled(const Matrix& A, const Vector& scale) {
  Matrix rows = scale.asDiagonal() * A;  // the largest entry of a row lies in [1, 2)
  return (rows.array().abs() < noise).select(0.0, rows);
}

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

BoxSolver::BoxSolver(const Matrix& A, const Vector& b) : BoxSolver(A, b, linalg::row_scales(A)) {}

BoxSolver::BoxSolver(Matrix A, const Vector& b, Vector scale)
    : scale_(std::move(scale)), A_(scaled(A, scale_)), b_(scale_.cwiseProduct(b)), simplex_(A_, b_) {}

BoxSolver::Status BoxSolver::maximize(VectorIn g, double enough) {
  const int power = power_of(g);
  objective_ = g;
  shift(objective_, -power);
  if (!guess_) guess_.emplace(A_, b_);
  point_.reset();
  const Status status = simplex_.maximize(objective_, guess_->scores(objective_), std::ldexp(enough, -power));
  if (status == Status::unsolved) return second_opinion(g);
  value_ = std::ldexp(simplex_.objective(), power);
  y_ = simplex_.multipliers();
  if (status != Status::infeasible) shift(y_, power);
  y_.array() *= scale_.array();
  return status;
}

BoxSolver::Status BoxSolver::second_opinion(VectorIn g) {
  // GLPK's tolerances are absolute: whatever the objective is, it sees one of some hundreds.
  const int power = power_of(g) - 8;
  objective_ = g;
  shift(objective_, -power);
  const Vector one = Vector::Ones(A_.cols());
  LinearProgram::Solution solution = LinearProgram(A_, b_, -one, one).maximize(objective_);
  if (solution.status != LinearProgram::Status::optimal) return Status::unsolved;
  value_ = std::ldexp(solution.objective, power);
  point_ = std::move(solution.x);
  y_ = std::move(solution.y);
  shift(y_, power);
  y_.array() *= scale_.array();
  return Status::optimal;
}

void BoxSolver::take_point(Vector& xi) {
  if (point_) {
    xi = *point_;
  } else {
    simplex_.take_point(xi);
  }
}

}  // namespace cordon
