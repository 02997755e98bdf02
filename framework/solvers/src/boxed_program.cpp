// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/boxed_program.hpp"

#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/core/tolerances.hpp"
#include "solvers/box_solver.hpp"
#include "solvers/row_certificates.hpp"
#include "solvers/row_gram.hpp"

namespace cordon {

namespace {

/// A bound that exceeds the value of its point by this share of the objective is worth another
/// solver's opinion.
constexpr double loose = 1e-7;
/// Solutions of Aξ = (1 + σ) b with σ below this at most: the proof of emptiness will have a
/// margin.
constexpr double clearly_empty = -1e-6;
/// An infeasibility smaller than this share of the terms it is made of may stem from the rounding
/// errors of nominal operations.

/// |ξ| + radius ≤ 1 in every coordinate, rounding included.
bool fits(VectorIn xi, const Vector& radius) {
  for (Index j = 0; j < xi.size(); ++j) {
    const double reach =
        radius[j] == 0 ? std::abs(xi[j]) : rounding::up(std::abs(xi[j]) + radius[j]);
    if (!(reach <= 1)) return false;
  }
  return true;
}

bool fits(const Vector& xi, double distance) {
  return xi.size() == 0 || rounding::up(xi.cwiseAbs().maxCoeff() + distance) <= 1;
}

}  // namespace

struct BoxedProgram::State {
  Matrix A;
  Vector b;
  Accuracy accuracy;  ///< complete: zeros where nothing was given
  RowCertificates certificates;
  std::optional<BoxSolver> objective_solver, scaling_solver;

  State(Matrix rows, Vector right, Accuracy known)
      : A(std::move(rows)),
        b(std::move(right)),
        accuracy(std::move(known)),
        certificates(A, b, accuracy.error) {}

  Answer is_empty(Certificate* why);

  BoxSolver& for_objectives() {
    if (!objective_solver) objective_solver.emplace(A, b);
    return *objective_solver;
  }

  /// max σ with Aξ = (1 + σ) b, ‖ξ‖∞ ≤ 1, |σ| ≤ 1: feasible in any case. σ* < 0 means empty, and
  /// the multipliers prove it; else ξ / (1 + σ*) is the solution of the rows with the smallest
  /// norm, or one of norm at most 1/2.
  BoxSolver& for_scaling() {
    if (!scaling_solver) {
      Matrix rows(A.rows(), A.cols() + 1);
      rows << A, -b;
      scaling_solver.emplace(rows, b);
    }
    return *scaling_solver;
  }

  /// Nothing is said about emptiness by less than what rounding may have added.
  bool prove_empty(const Vector& y, double& margin) const {
    margin = certificates.farkas_margin(y);
    const Vector terms = b.cwiseAbs() + certificates.reach() + accuracy.magnitude;
    return margin >
           tolerances::proof_margin * y.cwiseAbs().dot(terms.cwiseMax(tolerances::smallest_terms));
  }

  /// A proof that P is empty, if there is one: the proposal, or what the question itself finds.
  std::optional<Vector> farkas_vector(const Vector& proposal) {
    double margin = 0;
    if (prove_empty(proposal, margin)) return proposal;
    Certificate why;
    if (is_empty(&why) == Answer::yes) return std::move(why.data);
    return std::nullopt;
  }

  void take(VectorIn g, Bound& bound, const BoxSolver& solver) {
    bound.solved = true;
    const double upper = certificates.upper_bound(g, solver.multipliers());
    if (!(upper < bound.upper)) return;
    bound.upper = upper;
    bound.y = solver.multipliers();
  }

  /// What a proposal of this status, and if need be another solver's, proves.
  void propose(VectorIn g, Bound& bound, BoxSolver::Status status) {
    BoxSolver& solver = *objective_solver;
    if (status == BoxSolver::Status::infeasible) {
      if (auto y = farkas_vector(solver.multipliers())) {
        bound = {-infinity, std::move(*y), std::nullopt, true};
        return;
      }
      status = solver.second_opinion(g);
    }
    if (status != BoxSolver::Status::optimal) return;
    take(g, bound, solver);
    if (bound.upper - solver.value() <= loose * g.lpNorm<1>()) return;
    if (solver.second_opinion(g) == BoxSolver::Status::optimal) take(g, bound, solver);
  }

  /// ξ / (1 + σ) of a solution (ξ, σ) of the scaling program.
  std::optional<Vector> central(BoxSolver& solver) const {
    Vector solution;
    solver.take_point(solution);
    const double tau = 1 + solution[A.cols()];
    const Vector xi = solution.head(A.cols()) / tau;
    if (!(tau > 0) || !xi.allFinite()) return std::nullopt;
    return xi;
  }

  /// The row that the box misses most clearly, if it does (0ᵀξ = b ≠ 0 among them).
  std::optional<Vector> missed_row(double& margin) const {
    for (Index i = 0; i < A.rows(); ++i) {
      if (!(std::abs(b[i]) > certificates.reach()[i] * (1 - 1e-9))) continue;
      const Vector y = Vector::Unit(A.rows(), i) * (b[i] > 0 ? 1.0 : -1.0);
      if (prove_empty(y, margin)) return y;
    }
    return std::nullopt;
  }
};

BoxedProgram::BoxedProgram(Matrix A, Vector b, Accuracy accuracy) {
  if (A.rows() != b.size())
    throw Error(Errc::dimension, "boxed program: matrix and right-hand side differ in rows");
  if (!A.allFinite() || !b.allFinite())
    throw Error(Errc::not_finite, "boxed program: a NaN or infinite coefficient");
  for (Vector* part : {&accuracy.magnitude, &accuracy.error}) {
    if (part->size() == 0) part->setZero(b.size());
    if (part->size() != b.size())
      throw Error(Errc::dimension, "boxed program: the accuracy of the rows has the wrong size");
  }
  state_ = std::make_unique<State>(std::move(A), std::move(b), std::move(accuracy));
}
BoxedProgram::~BoxedProgram() = default;
BoxedProgram::BoxedProgram(BoxedProgram&&) noexcept = default;
BoxedProgram& BoxedProgram::operator=(BoxedProgram&&) noexcept = default;

BoxedProgram::Bound BoxedProgram::maximum(VectorIn g) {
  Bound bound;
  upper_bound(g, bound);
  if (!bound.solved || bound.upper == -infinity) return bound;
  if (state_->A.rows() == 0) {
    bound.xi = g.array().sign().matrix();
  } else {
    state_->objective_solver->take_point(bound.xi.emplace());
  }
  return bound;
}

void BoxedProgram::upper_bound(VectorIn g, Bound& bound) {
  State& s = *state_;
  if (g.size() != s.A.cols())
    throw Error(Errc::dimension, "boxed program: the objective has the wrong size");
  bound.solved = s.A.rows() == 0;
  bound.upper = infinity;
  bound.xi.reset();
  if (!bound.solved) s.propose(g, bound, s.for_objectives().maximize(g));
  if (bound.upper == -infinity) return;
  if (const double trivial = rounding::norm_1(g).upper; !(bound.upper < trivial)) {
    bound.upper = trivial;
    bound.y.setZero(s.A.rows());
  }
}

Answer BoxedProgram::is_empty(Certificate* why) { return state_->is_empty(why); }

Answer BoxedProgram::State::is_empty(Certificate* why) {
  const Index m = A.rows(), g = A.cols();
  const auto conclude = [&](Answer answer, Certificate::Kind kind, Vector data, double margin) {
    if (why) *why = {kind, std::move(data), margin};
    return answer;
  };
  if (why) *why = {};
  if (m == 0) return conclude(Answer::no, Certificate::Kind::structure, Vector(0), 1);
  double margin = 0;
  if (auto y = missed_row(margin))
    return conclude(Answer::yes, Certificate::Kind::farkas, std::move(*y), margin);

  const RowGram gram(A, b, accuracy.error);
  const auto point_proves = [&](const Vector& xi) {
    if (gram.is_regular() && fits(xi, gram.distance(xi))) return true;
    const std::optional<Vector> radius = repair_radius(A, b, xi, accuracy.error);
    return radius && fits(xi, *radius);
  };
  const auto found = [&](Vector xi) {
    margin = g ? 1 - xi.cwiseAbs().maxCoeff() : 1;
    return conclude(Answer::no, Certificate::Kind::point, std::move(xi), margin);
  };
  // Cheap first: the least-squares point proves either answer when it lies clearly inside or
  // outside.
  if (gram.is_regular()) {
    RowGram::Point point = gram.least_squares();
    if (fits(point.xi, gram.distance(point.xi))) return found(std::move(point.xi));
    if (prove_empty(point.y, margin))
      return conclude(Answer::yes, Certificate::Kind::farkas, std::move(point.y), margin);
  }
  BoxSolver& solver = for_scaling();
  const Vector sigma = Vector::Unit(g + 1, g);
  BoxSolver::Status status = solver.maximize(sigma, clearly_empty);
  if (status == BoxSolver::Status::infeasible) status = solver.second_opinion(sigma);
  if (status == BoxSolver::Status::unsolved) return Answer::unknown;
  if (Vector y = -solver.multipliers(); prove_empty(y, margin))
    return conclude(Answer::yes, Certificate::Kind::farkas, std::move(y), margin);
  if (status != BoxSolver::Status::optimal) return Answer::unknown;
  if (std::optional<Vector> xi = central(solver)) {
    if (point_proves(*xi)) return found(std::move(*xi));
  }
  return Answer::unknown;
}

std::optional<Vector> BoxedProgram::central_point(double beyond) {
  State& s = *state_;
  const Index g = s.A.cols();
  if (s.A.rows() == 0) return Vector(Vector::Zero(g));
  BoxSolver& solver = s.for_scaling();
  if (solver.maximize(Vector::Unit(g + 1, g)) != BoxSolver::Status::optimal) return std::nullopt;
  std::optional<Vector> xi = s.central(solver);
  if (!xi || (xi->size() && xi->cwiseAbs().maxCoeff() > 1 + beyond)) return std::nullopt;
  return xi;
}

double BoxedProgram::lower_support(VectorIn g, VectorIn xi) {
  const State& s = *state_;
  if (xi.size() && !(xi.cwiseAbs().maxCoeff() <= 1 + 1e-6)) return -infinity;
  const Vector inside = xi.cwiseMax(-1.0).cwiseMin(1.0);
  const std::optional<Vector> radius = repair_radius(s.A, s.b, inside, s.accuracy.error);
  if (!radius || !fits(inside, *radius)) return -infinity;
  return rounding::down(rounding::dot(g, inside).lower -
                        rounding::dot(g.cwiseAbs(), *radius).upper);
}

double farkas_margin(MatrixIn A, VectorIn b, VectorIn y, VectorIn error) {
  return RowCertificates(A, b, error).farkas_margin(y);
}

std::optional<Vector> repair_radius(MatrixIn A, VectorIn b, VectorIn xi, VectorIn error) {
  const Index g = A.cols();
  if (!xi.allFinite() || xi.size() != g) return std::nullopt;
  // Zero rows 0 = 0 hold by themselves; the others are scaled by powers of two, which is exact.
  const Vector scale = linalg::row_scales(A);
  Matrix rows(A.rows(), g);
  Vector right(A.rows()), unsure = Vector::Zero(A.rows());
  Index m = 0;
  for (Index i = 0; i < A.rows(); ++i) {
    if (g == 0 || A.row(i).isZero(0)) {
      if (b[i] != 0 || (error.size() && error[i] != 0)) return std::nullopt;
      continue;
    }
    rows.row(m) = A.row(i) * scale[i];
    if (error.size()) unsure[m] = error[i] * scale[i];
    right[m++] = b[i] * scale[i];
  }
  if (m == 0) return Vector(Vector::Zero(g));
  rows.conservativeResize(m, g);

  const Vector slack = (1 - xi.cwiseAbs().array()).cwiseMax(0.0).matrix();
  const Matrix weighted = slack.asDiagonal() *
                          rows.transpose();  // D Aᵀ as stored: the correction is sought in its span
  const Matrix K = linalg::product(rows, weighted);
  const std::optional<Matrix> R = linalg::solve(K, Matrix::Identity(m, m));
  if (!R || !R->allFinite()) return std::nullopt;

  // E = I - (A D Aᵀ) R, bounded entrywise: computed value, error of its own product, error of K
  // times |R|.
  const Matrix residual = Matrix::Identity(m, m) - linalg::product(K, *R);
  const Matrix distance =
      residual.cwiseAbs() + 2 * rounding::product_error(K, *R) +
      2 * linalg::product(rounding::product_error(rows, weighted), R->cwiseAbs()) +
      Matrix::Constant(m, m, 4 * rounding::unit);
  const double alpha = distance.rowwise().sum().maxCoeff() * (1 + 1e-10);
  if (!(alpha < 0.5)) return std::nullopt;

  Vector gap(m);  // |b - A ξ|, rounded up
  for (Index i = 0; i < m; ++i) {
    const Interval product = rounding::dot(rows.row(i).transpose(), xi);
    gap[i] = std::max(std::abs(rounding::up(right[i] - product.lower)),
                      std::abs(rounding::down(right[i] - product.upper)));
    if (unsure[i] > 0) gap[i] = rounding::up(gap[i] + unsure[i]);
  }
  // δ = D Aᵀ R (I - E)⁻¹ (b - Aξ), |(I - E)⁻¹ r| ≤ |r| + α/(1-α) ‖r‖∞
  const double spread = alpha / (1 - alpha) * gap.maxCoeff();
  const Vector v = (gap.array() + spread).matrix();
  const Matrix map = linalg::product(weighted, *R);
  const Matrix map_bound = map.cwiseAbs() + 2 * rounding::product_error(weighted, *R);
  Vector radius = linalg::product(map_bound, v) * (1 + 1e-10) + Vector::Constant(g, rounding::tiny);
  for (Index j = 0; j < g; ++j) {
    if (slack[j] == 0) radius[j] = 0;  // the correction has no part in a coordinate at its bound
  }
  return radius;
}

}  // namespace cordon
