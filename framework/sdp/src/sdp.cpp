// SPDX-License-Identifier: GPL-3.0-or-later
// Semidefinite programs: what the solver is asked, and what its answers are worth. Every number of
// an answer comes from the program as it was given, x, and dual matrices that are positive
// semidefinite up to the shift that is accounted for.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "sdp_infeasibility.hpp"
#include "sdp_products.hpp"
#include "sdp_proposal.hpp"
#include "sdp_scaling.hpp"

namespace cordon {

namespace {

void check_matrix(const Matrix& F, Index size, const std::string& what) {
  if (F.rows() != size || F.cols() != size)
    throw Error(Errc::dimension, "semidefinite program: " + what + " has the wrong size");
  if (!F.allFinite())
    throw Error(Errc::not_finite, "semidefinite program: " + what + " has a NaN or infinite entry");
  if (F != F.transpose())
    throw Error(Errc::invalid, "semidefinite program: " + what + " is not symmetric");
}

void check(const SemidefiniteProgram& program, const SdpOptions& options) {
  if (!(options.accuracy > 0) || !(options.largest_x > 0) || options.iterations < 1) {
    throw Error(Errc::invalid,
                "semidefinite program: accuracy, largest x and iterations must be positive");
  }
  if (program.cost.size() == 0) throw Error(Errc::dimension, "semidefinite program: no variables");
  if (program.inequalities.empty())
    throw Error(Errc::dimension, "semidefinite program: no inequalities");
  if (!program.cost.allFinite())
    throw Error(Errc::not_finite, "semidefinite program: a NaN or infinite cost");
  for (std::size_t j = 0; j < program.inequalities.size(); ++j) {
    const MatrixInequality& F = program.inequalities[j];
    const std::string name = "inequality " + std::to_string(j + 1);
    if (F.constant.rows() == 0)
      throw Error(Errc::dimension, "semidefinite program: " + name + " is empty");
    check_matrix(F.constant, F.constant.rows(), "the constant of " + name);
    std::vector<Index> seen;
    for (const auto& [i, term] : F.terms) {
      if (i < 0 || i >= program.cost.size())
        throw Error(Errc::dimension, "semidefinite program: no such variable in " + name);
      check_matrix(term, F.constant.rows(), "term " + std::to_string(i) + " of " + name);
      seen.push_back(i);
    }
    std::sort(seen.begin(), seen.end());
    if (std::adjacent_find(seen.begin(), seen.end()) != seen.end()) {
      throw Error(Errc::invalid, "semidefinite program: a variable twice in " + name);
    }
  }
}

/// Y without the negative part that the solver may have left.
Matrix semidefinite_part(const Matrix& Y) {
  const linalg::SymmetricEigen eigen = linalg::symmetric_eigen(Y);
  if (eigen.values[0] >= 0) return Y;
  const Matrix part =
      eigen.vectors * eigen.values.cwiseMax(0).asDiagonal() * eigen.vectors.transpose();
  return (part + part.transpose()) / 2;
}

/// An answer in the given program's own numbers: `solved` or `unknown`. `feasible` if its point
/// meets the inequalities.
SdpSolution assess(const SemidefiniteProgram& program, const ScaledProgram& scaled,
                   const SdpProposal& proposal, const SdpOptions& options, bool& feasible) {
  SdpSolution s;
  s.solver_status = proposal.phase;
  s.why = "the solver stopped without a solution (" + proposal.phase + ")";
  if (!proposal.x) return s;
  Vector x = Vector::Zero(program.cost.size());
  for (std::size_t i = 0; i < scaled.variables.size(); ++i) {
    x[scaled.variables[i]] =
        scaled.variable_scale[scaled.variables[i]] * (*proposal.x)[static_cast<Index>(i)];
  }
  std::vector<Matrix> Y = unscaled(scaled, proposal.Y, 1 / scaled.cost_scale);
  for (Matrix& part : Y) part = semidefinite_part(part);
  double violation = 0;
  for (const MatrixInequality& F : program.inequalities) {
    Matrix value = F.constant;
    double size = F.constant.cwiseAbs().maxCoeff();
    for (const auto& [i, term] : F.terms) {
      value += x[i] * term;
      size = std::max(size, std::abs(x[i]) * term.cwiseAbs().maxCoeff());
    }
    if (!value.allFinite()) return s;
    s.least_eigenvalue.push_back(linalg::symmetric_eigen(value).values[0]);
    if (s.least_eigenvalue.back() < 0)
      violation = std::max(violation, -s.least_eigenvalue.back() / size);
  }
  const Vector residual = inner_products(program, Y) - program.cost;
  s.value = program.cost.dot(x);
  s.dual_residual = residual.cwiseAbs().maxCoeff();
  // costᵀx' ≥ dual - |residual|ᵀ|x'| for every feasible x'.
  const double dual = -inner_constant(program, Y), unsure = residual.cwiseAbs().dot(x.cwiseAbs());
  s.bound = dual - unsure;
  const double gap = std::abs(s.value - dual) + unsure;
  const double taken = 100 * options.accuracy;
  const bool inside = x.cwiseAbs().maxCoeff() <= options.largest_x;
  feasible = inside && violation <= taken;
  if (!inside) {
    s.why = "the solver's point lies beyond the bound of |x| (" + proposal.phase + ")";
  } else if (scaled.without_bound) {
    s.why = "a variable that no inequality depends on lowers the cost without end";
  } else if (!feasible) {
    s.why = "the solver's point violates the inequalities (" + proposal.phase + ")";
  } else if (!(gap <= taken * (1 + program.cost.cwiseAbs().dot(x.cwiseAbs())))) {
    s.why = fmt::format(
        "value {:.10g} and bound {:.10g} differ, or the dual residual {:.2g} is too large ({})",
        s.value, s.bound, s.dual_residual, proposal.phase);
  } else {
    s.status = SdpStatus::solved;
    s.x = std::move(x);
    s.why.clear();
  }
  return s;
}

/// Constants alone: there is nothing to ask for.
SdpProposal constant_proposal(const SemidefiniteProgram& program) {
  SdpProposal proposal{"constant", Vector(), {}};
  for (const MatrixInequality& F : program.inequalities) proposal.Y.push_back(0 * F.constant);
  return proposal;
}

}  // namespace

SdpSolution solve(const SemidefiniteProgram& program, const SdpOptions& options) {
  check(program, options);
  const ScaledProgram scaled = scale(program);
  SdpSolution answer;
  bool any_feasible = false;
  for (const SdpTuning& tuning : tunings) {
    bool feasible = false;
    const SdpProposal proposal =
        scaled.variables.empty()
            ? constant_proposal(program)
            : run_sdpa(scaled.program, options.accuracy, options.iterations, tuning);
    answer = assess(program, scaled, proposal, options, feasible);
    if (answer.status == SdpStatus::solved) return answer;
    any_feasible = any_feasible || feasible;
  }
  prove_infeasible(scaled, options, answer);
  return answer;
}

}  // namespace cordon
