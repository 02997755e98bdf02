// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/checks/common_runs.hpp"

#include <limits>
#include <vector>

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/solvers/lp.hpp"
#include "solvers/rational_system.hpp"
#include "study/checks/equations.hpp"

namespace cordon::verification {

namespace {

// Limits of rows² × columns: seconds to a minute for numbers of full length, far less for short
// ones.
constexpr double most_to_check = 1e8, most_to_settle = 1e7;
constexpr double largest_scale =
    16;  // of the rows' right-hand side: beyond 1 it does not matter how far

Matrix identity(Index n) { return Matrix::Identity(n, n); }

/// The lines that models share, or none where they are not asked for.
struct Shared {
  std::vector<Equations::Line> u, y;  ///< by time; y of size 0 where the output does not count
};

/// What the model's matrices are products of, if they still are.
const LinearModel::Unscaled* unscaled(const LinearModel& m) {
  if (!m.unscaled) return nullptr;
  const LinearModel::Unscaled& s = *m.unscaled;
  const Matrix D = s.D * s.actuator.asDiagonal();
  const bool same = m.B == s.B * s.actuator.asDiagonal() && m.C == s.sensor.asDiagonal() * s.C &&
                    m.D == s.sensor.asDiagonal() * D;
  return same ? &s : nullptr;
}

/// B diag(f) u and diag(g) (C x + D diag(f) u) without their rounding: f and g stand in rows of
/// their own.
class Scaled {
 public:
  explicit Scaled(const LinearModel& m) : m_(m), unscaled_(unscaled(m)) {}

  const Matrix& B() const { return unscaled_ ? unscaled_->B : m_.B; }
  /// diag(f) u, for B.
  Equations::Line input(Equations& rows, const Equations::Line& u) const {
    if (!unscaled_) return u;
    const Equations::Line effective = rows.line(u.size);
    rows.add(u.size, {{effective, identity(u.size)},
                      {u, -unscaled_->actuator.asDiagonal().toDenseMatrix()}});
    return effective;
  }
  /// y = diag(g) (C x + D input) + Dv v
  void output(Equations& rows, const Equations::Line& y, const Equations::Line& x,
              const Equations::Line& input, const Equations::Line& v) const {
    if (!unscaled_)
      return rows.add(y.size, {{y, identity(y.size)}, {x, -m_.C}, {input, -m_.D}, {v, -m_.Dv}});
    const Equations::Line healthy = rows.line(y.size);
    rows.add(y.size, {{healthy, identity(y.size)}, {x, -unscaled_->C}, {input, -unscaled_->D}});
    rows.add(y.size, {{y, identity(y.size)},
                      {healthy, -unscaled_->sensor.asDiagonal().toDenseMatrix()},
                      {v, -m_.Dv}});
  }

 private:
  const LinearModel& m_;
  const LinearModel::Unscaled* unscaled_;
};

void add_run(Equations& rows, const TimedModel& models, const Shared& shared,
             const std::optional<LineForm>& admissible_set) {
  const LinearModel& first = models[0].linear;
  const Index n = first.states(), last = static_cast<Index>(shared.u.size()) - 1;
  const DescriptorMatrix E(first.is_descriptor() ? first.E : identity(n));
  const Matrix& determined = E.as_written ? E.left : E.right;  // its rows span the range of Eᵀ
  Equations::Line x = rows.element(models[0].X0);
  for (Index k = 0; k <= last; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const Model& model = models[k];
    const LinearModel& m = model.linear;
    const Scaled scaled(m);
    if (k > 0 && m.is_descriptor() && admissible_set) {
      const Equations::Line a = rows.element(*admissible_set),
                            lambda = rows.line(determined.rows());
      rows.add(n, {{x, identity(n)}, {a, -identity(n)}, {lambda, -determined.transpose()}});
    }
    const Equations::Line u = scaled.input(rows, shared.u[at]);
    if (shared.y[at].size > 0) scaled.output(rows, shared.y[at], x, u, rows.element(model.V));
    if (k == last && !m.is_descriptor()) break;
    const Equations::Line w = rows.element(model.W), next = rows.line(n);
    rows.add(n, {rows.product(E, next), {x, -m.A}, {u, -scaled.B()}, {w, -m.Bw}});
    x = next;
  }
}

/// max τ : Sδ + Aξ = τ b, ‖ξ‖∞ ≤ 1, as the floating-point solver sees it. The rows have a solution
/// if and only if τ ≥ 1, and -y is a Farkas vector otherwise.
struct Proposal {
  bool found = false;
  double tau = 0;
  Vector point;  ///< (δ, ξ) / τ, for τ > 0
  Vector y;
};
Proposal propose(const LineForm& X) {
  const Index l = X.lines(), g = X.generators(), m = X.constraints();
  Matrix rows(m, l + g + 1);
  rows << X.S, X.A, -X.b;
  const Vector scales = linalg::row_scales(rows);
  rows = scales.asDiagonal() * rows;
  Vector lower = Vector::Constant(l + g + 1, -infinity), upper = -lower,
         cost = Vector::Zero(l + g + 1);
  lower.segment(l, g).setConstant(-1);
  upper.segment(l, g).setConstant(1);
  lower[l + g] = 0;
  upper[l + g] = largest_scale;
  cost[l + g] = 1;
  const LinearProgram::Solution solution =
      LinearProgram(rows, Vector::Zero(m), lower, upper).maximize(cost);
  Proposal proposal;
  if (solution.status != LinearProgram::Status::optimal || !solution.x.allFinite() ||
      !solution.y.allFinite())
    return proposal;
  proposal.found = true;
  proposal.tau = solution.x[l + g];
  if (proposal.tau > 0) proposal.point = solution.x.head(l + g) / proposal.tau;
  proposal.y = -scales.cwiseProduct(solution.y);
  return proposal;
}

/// bᵀy / ‖Aᵀy‖₁ - 1, rounded down, if that is positive.
std::optional<double> proven_kappa(const rational::System& system, VectorIn y) {
  const auto terms = rational::farkas_terms(system, y);
  if (!terms || terms->gain <= terms->cost) return std::nullopt;
  if (sgn(terms->cost) == 0) return infinity;
  return rational::enclose(terms->gain / terms->cost - 1).lower;
}

}  // namespace

LineForm common_runs(std::span<const TimedModel* const> models, const Experiment& experiment) {
  Equations rows;
  Shared shared;
  const Index outputs = models.size() > 1 ? (*models[0])[0].linear.outputs() : 0,
              last = experiment.u.rows() - 1;
  for (Index k = 0; k <= last; ++k) {
    shared.u.push_back(rows.constant(experiment.u.row(k).transpose()));
    shared.y.push_back(rows.line(k == last || !experiment.last_output_only ? outputs : 0));
  }
  for (const TimedModel* model : models) add_run(rows, *model, shared, experiment.admissible_set);
  return rows.project(rows.line(0));
}

LineForm output_tube(const TimedModel& model, const Experiment& experiment) {
  Equations rows;
  Shared shared;
  const Index outputs = model[0].linear.outputs(), last = experiment.u.rows() - 1;
  const Equations::Line all =
      rows.line(experiment.last_output_only ? outputs : (last + 1) * outputs);
  Index first = all.first;
  for (Index k = 0; k <= last; ++k) {
    const Index counted = k == last || !experiment.last_output_only ? outputs : 0;
    shared.u.push_back(rows.constant(experiment.u.row(k).transpose()));
    shared.y.push_back({first, counted});
    first += counted;
  }
  add_run(rows, model, shared, experiment.admissible_set);
  return rows.project(all);
}

ExactEmptiness exact_emptiness(const LineForm& X) {
  const auto rows_count = static_cast<double>(X.constraints()),
             columns = static_cast<double>(X.lines() + X.generators());
  const double work = rows_count * rows_count * columns;
  const auto too_large = [&](const char* what) {
    return ExactEmptiness{
        Answer::unknown, 0,
        fmt::format(
            "{}: {} lines and generators with {} constraints are too many in rational arithmetic",
            what, X.lines() + X.generators(), X.constraints())};
  };
  if (work > most_to_check) return too_large("not tried");
  const rational::Rows rows{X.S, X.A, X.b, Vector::Zero(X.constraints())};
  const rational::System system(rows);
  const auto disjoint = [&](double kappa) { return ExactEmptiness{Answer::yes, kappa, {}}; };
  const ExactEmptiness meet{Answer::no, 0, {}};
  const Proposal proposal = propose(X);
  if (proposal.found && proposal.tau < 1) {
    if (const auto kappa = proven_kappa(system, proposal.y)) return disjoint(*kappa);
  }
  if (proposal.found && proposal.tau > 0 && rational::has_solution_near(system, proposal.point))
    return meet;
  if (work > most_to_settle) return too_large("no proof was restored from doubles");
  const rational::Finding found =
      rational::settle(rows);  // its answer is exact, its data are rounded
  if (found.feasible) return meet;
  return disjoint(proven_kappa(system, found.data).value_or(0));
}

LineForm with_reach(const LineForm& X, double reach) {
  if (!(reach > 0)) throw Error(Errc::invalid, "with_reach: the reach must be positive");
  const Index m = X.constraints(), l = X.lines(), g = X.generators();
  LineForm wide = X;  // S δ + A ξ - b t = 0, reach t = 1
  wide.M.conservativeResize(Eigen::NoChange, l + 1);
  wide.M.col(l).setZero();
  wide.S = Matrix::Zero(m + 1, l + 1);
  wide.S.topLeftCorner(m, l) = X.S;
  wide.S.col(l) << -X.b, reach;
  wide.A = Matrix::Zero(m + 1, g);
  wide.A.topRows(m) = X.A;
  wide.b = Vector::Unit(m + 1, m);
  return wide;
}

}  // namespace cordon::verification
