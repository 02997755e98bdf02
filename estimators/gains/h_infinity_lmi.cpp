// SPDX-License-Identifier: GPL-3.0-or-later
#include "gains/h_infinity_lmi.hpp"

#include "cordon/core/linalg.hpp"
#include "gains/gain_certificate.hpp"

namespace cordon::estimators {

HInfinityProgram h_infinity_program(const ErrorDynamics& errors, bool diagonal_P) {
  const Index n = errors.A.rows(), e = errors.E.cols(), v = errors.N.cols();
  HInfinityProgram design;
  design.P = diagonal_P ? diagonal_variable(0, n) : symmetric_variable(0, n);
  design.M = full_variable(design.P.end(), n, errors.C.rows());
  const MatrixVariable gamma_e{design.M.end(), {Matrix::Identity(e, e)}}, gamma_v{design.M.end(), {Matrix::Identity(v, v)}},
      gamma_n{design.M.end(), {Matrix::Identity(n, n)}};
  design.program.cost = Vector::Unit(gamma_n.end(), gamma_n.first);
  const Matrix I = Matrix::Identity(n, n);
  BlockInequality lmi({n, n, e, v, n});
  lmi.add(0, 0, design.P, I);
  lmi.add(0, 1, design.P, errors.A);
  lmi.add(0, 1, design.M, -errors.C);
  lmi.add(0, 2, design.P, errors.E);
  lmi.add(0, 3, design.M, -errors.N);
  lmi.add(1, 1, design.P, I);
  lmi.add(1, 4, I);
  lmi.add(2, 2, gamma_e, Matrix::Identity(e, e));
  lmi.add(3, 3, gamma_v, Matrix::Identity(v, v));
  lmi.add(4, 4, gamma_n, I);
  design.program.inequalities.push_back(std::move(lmi).finish());
  return design;
}

std::optional<Matrix> gain_of(const HInfinityProgram& design, const Vector& x) {
  return linalg::solve_spd(design.P.value(x), design.M.value(x));
}

GainDesign h_infinity_design(const Model& model, const Matrix& theta, const ErrorDynamics& errors, Matrix L,
                             const SdpSolution& s) {
  if (const std::string problem = gain_problem(model, L); !problem.empty()) {
    return no_gain(Answer::unknown, "the gain of the matrix inequality " + problem);
  }
  GainDesign design;
  design.gain.certificate = certify(model, L, theta);
  design.gain.L = std::move(L);
  GainCertificate& c = design.gain.certificate;
  c.objective = "γ";
  c.optimum = errors.unit * s.value;
  c.optimum_bound = errors.unit * s.bound;
  c.margin = s.least_eigenvalue[0];
  if (!(c.norm_upper <= c.optimum * (1 + 1e-4))) {
    return no_gain(Answer::unknown, "the gain of the matrix inequality does not keep what the inequality promises: its norm is " +
                                        std::to_string(c.norm_upper) + ", not " + std::to_string(c.optimum));
  }
  design.feasible = Answer::yes;
  return design;
}

}  // namespace cordon::estimators
