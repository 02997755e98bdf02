// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/h_infinity_lmi.hpp"

#include <algorithm>

#include "cordon/core/linalg.hpp"
#include "gains/gain_certificate.hpp"
#include "gains/monotone.hpp"

namespace cordon::estimators {

namespace {

struct HInfinityProgram {
  MatrixVariable P, M;
  SemidefiniteProgram program;
};

/// P A - M C ≥ 0 with diagonal P, entry by entry.
void add_monotonicity(const ErrorDynamics& errors, HInfinityProgram& design) {
  const Index n = errors.A.rows(), p = errors.C.rows();
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      MatrixInequality entry{Matrix::Zero(1, 1), {}};
      if (errors.A(i, j) != 0)
        entry.terms.emplace_back(design.P.first + i, Matrix::Constant(1, 1, errors.A(i, j)));
      for (Index k = 0; k < p; ++k) {
        if (errors.C(k, j) != 0)
          entry.terms.emplace_back(design.M.first + k * n + i,
                                   Matrix::Constant(1, 1, -errors.C(k, j)));
      }
      if (!entry.terms.empty()) design.program.inequalities.push_back(std::move(entry));
    }
  }
}

/// In coordinates z = T e; the norm is that of e.
HInfinityProgram h_infinity_program(const ErrorDynamics& errors, const Matrix& T,
                                    const Matrix& T_inverse, bool monotone) {
  const Index n = errors.A.rows(), disturbances = errors.E.cols();
  const ErrorDynamics z{linalg::product(linalg::product(T, errors.A), T_inverse),
                        linalg::product(errors.C, T_inverse), linalg::product(T, errors.E),
                        errors.N, errors.unit};
  HInfinityProgram design;
  design.P = monotone ? diagonal_variable(0, n) : symmetric_variable(0, n);
  design.M = full_variable(design.P.end(), n, z.C.rows());
  const MatrixVariable gamma_d{design.M.end(), {Matrix::Identity(disturbances, disturbances)}},
      gamma_n{design.M.end(), {Matrix::Identity(n, n)}};
  design.program.cost = Vector::Unit(gamma_n.end(), gamma_n.first);
  const Matrix I = Matrix::Identity(n, n);
  BlockInequality lmi({n, n, disturbances, n});
  lmi.add(0, 0, design.P, I);
  lmi.add(0, 1, design.P, z.A);
  lmi.add(0, 1, design.M, -z.C);
  lmi.add(0, 2, design.P, z.E);
  lmi.add(0, 2, design.M, -z.N);
  lmi.add(1, 1, design.P, I);
  lmi.add(1, 3, T_inverse.transpose());
  lmi.add(2, 2, gamma_d, Matrix::Identity(disturbances, disturbances));
  lmi.add(3, 3, gamma_n, I);
  design.program.inequalities.push_back(std::move(lmi).finish());
  if (monotone) add_monotonicity(z, design);
  return design;
}

/// Solutions are right to some 1e-8 of the largest disturbance: of a γ that is smaller than this,
/// four digits would not be.
constexpr double least_value = 1e-3;

/// What the solution is worth: its gain with the certificate, or why it is not accepted. `P` is
/// that of e.
GainDesign accepted(const Model& model, const Matrix& theta, const ErrorDynamics& errors,
                    HInfinityKind kind, const SdpSolution& s, const Matrix& P, const Matrix& PL) {
  const auto [form, monotone] = kind;
  const std::optional<Matrix> solved = linalg::solve_spd(P, PL);
  if (!solved)
    return no_gain(Answer::unknown, "the matrix P of the solution is not positive definite");
  Matrix L = monotone ? made_monotone(errors.A, errors.C, *solved) : *solved;
  if (monotone && !is_monotone(errors.A, errors.C, L)) {
    return no_gain(Answer::unknown,
                   "the gain of the matrix inequality is monotone up to the solver's errors only");
  }
  if (const std::string problem = gain_problem(model, L, form); !problem.empty()) {
    return no_gain(Answer::unknown, "the gain of the matrix inequality " + problem);
  }
  if (s.value < least_value) {
    return no_gain(Answer::unknown,
                   "the least norm lies below a thousandth of the largest disturbance, where the "
                   "solver's errors are too much of it",
                   "\"kalman\", or other units for outputs and disturbances");
  }
  GainDesign design;
  design.gain.certificate = certify(model, L, theta, form);
  design.gain.L = std::move(L);
  GainCertificate& c = design.gain.certificate;
  c.objective = "γ";
  c.optimum = errors.unit * s.value;
  c.optimum_bound = errors.unit * s.bound;
  c.margin = s.least_eigenvalue[0];
  if (!monotone &&
      !(c.norm_upper >=
        c.optimum_bound * (1 - 1e-4))) {  // monotone: γ by a diagonal P may be above the norm
    return no_gain(Answer::unknown,
                   "the bound of the matrix inequality is none: its gain has a smaller norm");
  }
  if (!monotone) c.optimum_bound = std::min(c.optimum_bound, c.norm_upper);
  // no gain at all is one as well; with a diagonal P its value may lie above its norm, but for 0
  const Matrix none = Matrix::Zero(design.gain.L.rows(), design.gain.L.cols());
  if (gain_problem(model, none, form).empty() &&
      (!monotone || is_monotone(errors.A, errors.C, none))) {
    const double norm = certify(model, none, theta, form).norm_upper;
    if (!monotone || norm == 0) c.optimum_bound = std::min(c.optimum_bound, norm);
  }
  if (!(c.norm_lower <= c.optimum * (1 + 1e-4))) {
    return no_gain(Answer::unknown,
                   "the gain of the matrix inequality does not keep what the inequality promises: "
                   "its norm is " +
                       std::to_string(c.norm_lower) + " at least, not " +
                       std::to_string(c.optimum));
  }
  design.feasible = Answer::yes;
  return design;
}

}  // namespace

GainDesign h_infinity_design(const Model& model, const Matrix& theta, const ErrorDynamics& errors,
                             HInfinityKind kind) {
  constexpr double accuracy = 1e-8, coarse = 1e-3;
  constexpr int rounds = 3;
  Matrix T = Matrix::Identity(errors.A.rows(), errors.A.rows()), T_inverse = T;
  GainDesign design;
  for (int round = 0; round < rounds; ++round) {
    const HInfinityProgram program = h_infinity_program(errors, T, T_inverse, kind.monotone);
    SdpSolution s = solve(program.program, {accuracy});
    GainDesign found = unsolved(s);
    if (s.status == SdpStatus::solved) {
      // P and PL of e are TᵀPT and TᵀPL of z.
      const Matrix P = linalg::transposed_product(T, linalg::product(program.P.value(s.x), T));
      found = accepted(model, theta, errors, kind, s, P,
                       linalg::transposed_product(T, program.M.value(s.x)));
    }
    if (found.feasible == Answer::yes || round == 0) design = std::move(found);
    if (design.feasible == Answer::yes) break;
    if (s.status != SdpStatus::solved) s = solve(program.program, {coarse});
    if (s.status != SdpStatus::solved) break;
    const std::optional<Matrix> root = linalg::cholesky(program.P.value(s.x));
    if (!root) break;
    T = linalg::product(root->transpose(), T);
    const std::optional<Matrix> inverse = linalg::solve(T, Matrix::Identity(T.rows(), T.cols()));
    if (!inverse) break;
    T_inverse = *inverse;
  }
  return design;
}

}  // namespace cordon::estimators
