// SPDX-License-Identifier: GPL-3.0-or-later
// The gain with the least bound of the H∞ norm among those with A - L C ≥ 0 in every entry.
#include <limits>

#include "components.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/solvers/lp.hpp"
#include "gains/h_infinity_lmi.hpp"
#include "gains/monotone.hpp"
#include "gains/theta.hpp"

namespace cordon::estimators {

namespace {

constexpr const char* details =
    R"(The matrix inequality of "h_infinity" with two conditions more: P is diagonal, and

  PA - MC ≥ 0 in every entry,

so that L = P⁻¹M makes A - L C ≥ 0: an upper and a lower bound of the state then evolve each on its own.
γ is minimised; it bounds the norm of the gain, and γ* is the best bound that a diagonal P proves.

The paper asks for the same inequality (54), (55) with a full P, which does not make A - L C ≥ 0; and it
prints +γI in (54a) and (55a), with which there is no solution.

Entries of PA - MC that are zero for every M and P have no interior and are left out. Where no gain makes
A - L C monotone and stable, which linear programs decide, that is the answer, with the reason; such as
"column 2 of C is zero and A(1,2) < 0". The gain that is found is moved by the solver's errors, so that
A - L C ≥ 0 holds for the numbers themselves where that is possible.
)";

/// PA - MC ≥ 0, but for the entries that are always zero.
void add_monotonicity(const ErrorDynamics& errors, HInfinityProgram& design) {
  const Index n = errors.A.rows(), p = errors.C.rows();
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      MatrixInequality entry{Matrix::Zero(1, 1), {}};
      if (errors.A(i, j) != 0) entry.terms.emplace_back(design.P.first + i, Matrix::Constant(1, 1, errors.A(i, j)));
      for (Index k = 0; k < p; ++k) {
        if (errors.C(k, j) != 0) entry.terms.emplace_back(design.M.first + k * n + i, Matrix::Constant(1, 1, -errors.C(k, j)));
      }
      if (!entry.terms.empty()) design.program.inequalities.push_back(std::move(entry));
    }
  }
}

/// The gain nearest to L, row by row, with A - L C ≥ 0: ‖d‖₁ least with A_i - (L_i + d) C ≥ 0. In units of the violation, since
/// the tolerances of linear programs are absolute; entries that are far from 0 in them do not matter.
Matrix projected(const ErrorDynamics& errors, Matrix L) {
  const Index n = errors.A.rows(), p = errors.C.rows();
  Matrix rows(n, 2 * p + n);
  rows << errors.C.transpose(), -errors.C.transpose(), Matrix::Identity(n, n);
  const Vector lower = Vector::Zero(2 * p + n), upper = Vector::Constant(2 * p + n, std::numeric_limits<double>::infinity());
  Vector cost = Vector::Zero(2 * p + n);
  cost.head(2 * p).setConstant(-1);
  for (Index i = 0; i < n; ++i) {
    const Vector closed = (errors.A.row(i) - L.row(i) * errors.C).transpose();
    const double violation = -closed.minCoeff();
    if (violation <= 0) continue;
    LinearProgram program(rows, (closed / violation).cwiseMin(1e6), lower, upper);
    const LinearProgram::Solution s = program.maximize(cost);
    if (s.status != LinearProgram::Status::optimal) continue;
    L.row(i) += violation * (s.x.head(p) - s.x.segment(p, p)).transpose();
  }
  return L;
}

/// A - L C ≥ 0 up to 1e-12 of its terms.
bool is_monotone(const ErrorDynamics& errors, const Matrix& L) {
  const Matrix closed = errors.A - linalg::product(L, errors.C);
  const Matrix terms = errors.A.cwiseAbs() + linalg::product(L.cwiseAbs(), errors.C.cwiseAbs());
  return (closed.array() >= -1e-12 * terms.array()).all();
}

class HInfinityMonotone final : public GainDesigner {
 public:
  explicit HInfinityMonotone(std::optional<Matrix> theta) : theta_(std::move(theta)) {}

  GainDesign design(const Model& model) const override {
    const Matrix theta = theta_of(model, theta_);
    const ErrorDynamics errors = error_dynamics(model, theta);
    if (std::optional<std::string> reason = no_monotone_gain(errors.A, errors.C)) {
      return no_gain(Answer::no, std::move(*reason), "an observer that needs no monotone gain, or states in which there is one");
    }
    if (std::optional<GainDesign> none = without_gain(errors)) return std::move(*none);
    HInfinityProgram program = h_infinity_program(errors, true);
    add_monotonicity(errors, program);
    const SdpSolution s = solve(program.program, {1e-8});
    if (s.status != SdpStatus::solved) return unsolved(s);
    std::optional<Matrix> L = gain_of(program, s.x);
    if (!L) return no_gain(Answer::unknown, "the matrix P of the solution is not positive definite");
    *L = raised_to_monotone(errors.A, errors.C, projected(errors, std::move(*L)));
    if (!is_monotone(errors, *L)) {
      return no_gain(Answer::unknown, "the gain of the matrix inequality is monotone up to the solver's errors only");
    }
    return h_infinity_design(model, theta, errors, std::move(*L), s);
  }

 private:
  std::optional<Matrix> theta_;
};

}  // namespace

void register_h_infinity_monotone_gain(Registrar& registrar) {
  ParamSchema schema;
  add_theta_parameter(schema);
  registrar.gain({{"h_infinity_monotone", "the least bound of the H∞ norm by a diagonal P, among gains with A - L C ≥ 0",
                   "Pourasghar2021", std::move(schema), details},
                  check_design,
                  [](const Params& params) { return std::make_unique<HInfinityMonotone>(theta_from(params)); }});
}

}  // namespace cordon::estimators
