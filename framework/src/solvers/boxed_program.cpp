// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/solvers/boxed_program.hpp"

#include <cmath>
#include <limits>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/core/rounding.hpp"
#include "cordon/solvers/lp.hpp"

namespace cordon {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Coefficients below this share of their row are left out of what the solver sees; the certificates see everything.
constexpr double proposal_tolerance = 1e-13;
/// An infeasibility smaller than this share of the terms it is made of may stem from the rounding errors of nominal operations.
constexpr double nominal_tolerance = 1e-10;

/// |ξ| + radius ≤ 1 in every coordinate, rounding included.
bool fits(VectorIn xi, const Vector& radius) {
  for (Index j = 0; j < xi.size(); ++j) {
    const double reach = radius[j] == 0 ? std::abs(xi[j]) : rounding::up(std::abs(xi[j]) + radius[j]);
    if (!(reach <= 1)) return false;
  }
  return true;
}

/// What an uncertain right-hand side adds to bᵀy at most.
double doubt(VectorIn error, VectorIn y) { return error.isZero(0) ? 0.0 : rounding::dot(error, y.cwiseAbs()).upper; }

double upper_bound(VectorIn g, const Matrix& A, const Vector& b, const Vector& y, VectorIn error) {
  return rounding::up(rounding::up(rounding::dot(b, y).upper + rounding::residual_norm_1(g, A, y)) + doubt(error, y));
}

}  // namespace

struct BoxedProgram::State {
  Matrix A;
  Vector b;
  Accuracy accuracy;  ///< complete: zeros where nothing was given
  Vector scale;       ///< row scales of the solver's programs
  std::optional<LinearProgram> objective_program, scaling_program;

  Matrix proposal_matrix() const {
    Matrix P = scale.asDiagonal() * A;
    for (Index i = 0; i < P.rows(); ++i) {
      const double tiny = proposal_tolerance * (P.cols() ? P.row(i).cwiseAbs().maxCoeff() : 0.0);
      for (Index j = 0; j < P.cols(); ++j) {
        if (std::abs(P(i, j)) < tiny) P(i, j) = 0;
      }
    }
    return P;
  }

  LinearProgram& for_objectives() {
    if (!objective_program) {
      const Vector one = Vector::Ones(A.cols());
      objective_program.emplace(proposal_matrix(), scale.cwiseProduct(b), -one, one);
    }
    return *objective_program;
  }

  /// max τ with Aξ = τ b, ‖ξ‖∞ ≤ 1, 0 ≤ τ ≤ 2: feasible at 0 in any case. τ* < 1 means empty, and the multipliers prove it;
  /// else ξ/τ* is the solution of the rows with the smallest norm, or one of norm at most 1/2.
  LinearProgram::Solution scaled() {
    const Index g = A.cols();
    if (!scaling_program) {
      Matrix rows(A.rows(), g + 1);
      rows.leftCols(g) = proposal_matrix();
      rows.col(g) = -scale.cwiseProduct(b);
      Vector lower = Vector::Constant(g + 1, -1.0), upper = Vector::Ones(g + 1);
      lower[g] = 0;
      upper[g] = 2;
      scaling_program.emplace(rows, Vector::Zero(A.rows()), lower, upper);
    }
    return scaling_program->maximize(Vector::Unit(g + 1, g));
  }
};

BoxedProgram::BoxedProgram(Matrix A, Vector b, Accuracy accuracy) : state_(std::make_unique<State>()) {
  if (A.rows() != b.size()) throw Error(Errc::dimension, "boxed program: matrix and right-hand side differ in rows");
  if (!A.allFinite() || !b.allFinite()) throw Error(Errc::not_finite, "boxed program: a NaN or infinite coefficient");
  state_->scale = linalg::row_scales(A);
  state_->A = std::move(A);
  state_->b = std::move(b);
  for (Vector* part : {&accuracy.magnitude, &accuracy.error}) {
    if (part->size() == 0) part->setZero(state_->b.size());
    if (part->size() != state_->b.size())
      throw Error(Errc::dimension, "boxed program: the accuracy of the rows has the wrong size");
  }
  state_->accuracy = std::move(accuracy);
}
BoxedProgram::~BoxedProgram() = default;
BoxedProgram::BoxedProgram(BoxedProgram&&) noexcept = default;
BoxedProgram& BoxedProgram::operator=(BoxedProgram&&) noexcept = default;

BoxedProgram::Bound BoxedProgram::maximum(VectorIn g) {
  State& s = *state_;
  if (g.size() != s.A.cols()) throw Error(Errc::dimension, "boxed program: the objective has the wrong size");
  const Vector none = Vector::Zero(s.A.rows());
  Bound bound{upper_bound(g, s.A, s.b, none, s.accuracy.error), none, std::nullopt, false};
  if (s.A.rows() == 0) {
    bound.xi = g.array().sign().matrix();
    bound.solved = true;
    return bound;
  }
  // The solver's tolerances are absolute: whatever the objective is, it sees one of some hundreds. Larger ones it scales itself.
  const double largest = g.size() ? g.cwiseAbs().maxCoeff() : 0;
  const int power = largest > 0 && std::isfinite(largest) ? std::ilogb(largest) - 8 : 0;
  const auto shifted = [](VectorIn v, int by) { return Vector(v.unaryExpr([by](double x) { return std::ldexp(x, by); })); };
  const LinearProgram::Solution solution = s.for_objectives().maximize(shifted(g, -power));
  if (solution.status == LinearProgram::Status::optimal) {
    const Vector y = s.scale.cwiseProduct(shifted(solution.y, power));
    if (const double upper = upper_bound(g, s.A, s.b, y, s.accuracy.error); upper < bound.upper) {
      bound.upper = upper;
      bound.y = y;
    }
    bound.xi = solution.x;
    bound.solved = true;
  } else if (Certificate why; is_empty(&why) == Answer::yes) {
    bound = {-infinity, why.data, std::nullopt, true};
  }
  return bound;
}

Answer BoxedProgram::is_empty(Certificate* why) {
  State& s = *state_;
  const Index m = s.A.rows(), g = s.A.cols();
  const auto conclude = [&](Answer answer, Certificate::Kind kind, Vector data, double margin) {
    if (why) *why = {kind, std::move(data), margin};
    return answer;
  };
  if (why) *why = {};
  if (m == 0) return conclude(Answer::no, Certificate::Kind::structure, Vector(0), 1);

  const Vector weight = s.b.cwiseAbs() + (g ? Vector(s.A.cwiseAbs().rowwise().sum()) : Vector::Zero(m)) + s.accuracy.magnitude;
  const auto empty_by = [&](const Vector& y, double& margin) {
    margin = farkas_margin(s.A, s.b, y, s.accuracy.error);
    return margin > nominal_tolerance * y.cwiseAbs().dot(weight);
  };
  double margin = 0;
  for (Index i = 0; i < m; ++i) {  // a single row that the box cannot meet (0ᵀξ = b ≠ 0 among them)
    if (s.b[i] == 0) continue;
    const Vector y = Vector::Unit(m, i) * (s.b[i] > 0 ? 1.0 : -1.0);
    if (empty_by(y, margin)) return conclude(Answer::yes, Certificate::Kind::farkas, y, margin);
  }
  const auto point_proves = [&](const Vector& xi) {
    const std::optional<Vector> radius = repair_radius(s.A, s.b, xi, s.accuracy.error);
    return radius && fits(xi, *radius);
  };
  // Cheap first: the least-squares point proves either answer when it lies clearly inside or outside.
  const Matrix scaled = s.scale.asDiagonal() * s.A;
  if (const auto dual = linalg::solve_spd(linalg::product(scaled, scaled.transpose()), s.scale.cwiseProduct(s.b))) {
    const Vector y = s.scale.cwiseProduct(dual->col(0));
    const Vector xi = linalg::product(s.A.transpose(), y);
    if (xi.allFinite() && (g == 0 || xi.cwiseAbs().maxCoeff() < 0.999) && point_proves(xi)) {
      return conclude(Answer::no, Certificate::Kind::point, xi, g ? 1 - xi.cwiseAbs().maxCoeff() : 1);
    }
    if (y.allFinite() && empty_by(y, margin)) return conclude(Answer::yes, Certificate::Kind::farkas, y, margin);
  }
  const LinearProgram::Solution solution = s.scaled();
  if (solution.status != LinearProgram::Status::optimal) return Answer::unknown;
  const Vector y = -s.scale.cwiseProduct(solution.y);
  if (empty_by(y, margin)) return conclude(Answer::yes, Certificate::Kind::farkas, y, margin);
  if (solution.objective >= 1) {
    const Vector xi = solution.x.head(g) / solution.objective;
    if (point_proves(xi)) return conclude(Answer::no, Certificate::Kind::point, xi, g ? 1 - xi.cwiseAbs().maxCoeff() : 1);
  }
  return Answer::unknown;
}

std::optional<Vector> BoxedProgram::central_point(double beyond) {
  State& s = *state_;
  if (s.A.rows() == 0) return Vector(Vector::Zero(s.A.cols()));
  const LinearProgram::Solution solution = s.scaled();
  if (solution.status != LinearProgram::Status::optimal || solution.objective <= 0) return std::nullopt;
  const Vector xi = solution.x.head(s.A.cols()) / solution.objective;
  if (!xi.allFinite() || (xi.size() && xi.cwiseAbs().maxCoeff() > 1 + beyond)) return std::nullopt;
  return xi;
}

double BoxedProgram::attained(VectorIn g, VectorIn xi) {
  const State& s = *state_;
  if (xi.size() && !(xi.cwiseAbs().maxCoeff() <= 1 + 1e-6)) return -infinity;
  const Vector inside = xi.cwiseMax(-1.0).cwiseMin(1.0);
  const std::optional<Vector> radius = repair_radius(s.A, s.b, inside, s.accuracy.error);
  if (!radius || !fits(inside, *radius)) return -infinity;
  return rounding::down(rounding::dot(g, inside).lower - rounding::dot(g.cwiseAbs(), *radius).upper);
}

double farkas_margin(MatrixIn A, VectorIn b, VectorIn y, VectorIn error) {
  if (!y.allFinite()) return -infinity;
  const double margin = rounding::down(rounding::dot(b, y).lower - rounding::residual_norm_1(Vector::Zero(A.cols()), A, y));
  return rounding::down(margin - doubt(error, y));
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
  const Matrix weighted = slack.asDiagonal() * rows.transpose();  // D Aᵀ as stored: the correction is sought in its span
  const Matrix K = linalg::product(rows, weighted);
  const std::optional<Matrix> R = linalg::solve(K, Matrix::Identity(m, m));
  if (!R || !R->allFinite()) return std::nullopt;

  // E = I - (A D Aᵀ) R, bounded entrywise: computed value, error of its own product, error of K times |R|.
  const Matrix residual = Matrix::Identity(m, m) - linalg::product(K, *R);
  const Matrix distance = residual.cwiseAbs() + 2 * rounding::product_error(K, *R) +
                          2 * linalg::product(rounding::product_error(rows, weighted), R->cwiseAbs()) +
                          Matrix::Constant(m, m, 4 * rounding::unit);
  const double alpha = distance.rowwise().sum().maxCoeff() * (1 + 1e-10);
  if (!(alpha < 0.5)) return std::nullopt;

  Vector gap(m);  // |b - A ξ|, rounded up
  for (Index i = 0; i < m; ++i) {
    const rounding::Range product = rounding::dot(rows.row(i).transpose(), xi);
    gap[i] = std::max(std::abs(rounding::up(right[i] - product.lower)), std::abs(rounding::down(right[i] - product.upper)));
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
