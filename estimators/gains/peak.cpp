// SPDX-License-Identifier: GPL-3.0-or-later
// The gain of least steady widths among those that make A - L C̄ monotone: a linear program.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "components.hpp"
#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/solvers/lp.hpp"
#include "gains/gain_certificate.hpp"
#include "gains/monotone.hpp"
#include "gains/theta.hpp"

namespace cordon::estimators {

namespace {

constexpr double rounding_share = 1e-12;  ///< of multipliers

constexpr const char* peak_details =
    "Where A - L C ≥ 0, bounds of the state by intervals settle at the half widths h = (I - (A - L "
    "C))⁻¹ (r + |L Ev| 1),\n"
    "r = |Eω| 1 + |Eθ| 1, with Eω = Bw G_W and Ev = Dv G_V for zonotopes around W and V. Their sum "
    "1ᵀh is least for\n"
    "L = diag(λ)⁻¹ Z, where λ, Z and S solve the linear program\n"
    "  minimise λᵀr + 1ᵀS 1   subject to   -S ≤ Z Ev ≤ S,\n"
    "  diag(λ) A - Z C ≥ 0,   λᵀ - 1ᵀ(diag(λ) A - Z C) ≥ 1ᵀ,\n"
    "which is feasible if and only if some gain makes A - L C monotone and stable: λᵀ is then a "
    "bound of 1ᵀ(I - (A - L C))⁻¹.\n"
    "That there is none is said on a proof only.\n"
    "For observers that correct a predicted set (\"gain_correction\", \"error_hull\") (I - L C) A "
    "takes the place of A - L C,\n"
    "and L acts on what disturbs the state as well: S ≥ |diag(λ) [Eθ Eω 0] - Z [C Eθ  C Eω  Ev]|, "
    "and 1ᵀS 1 is minimised.";

/// In units in which rows of C and the objective are near 1: solvers take what is below 1e-7 for
/// nothing.
struct Units {
  Vector outputs;
  double objective;
};

/// What disturbs the errors, e⁺ = (A - L C) e + (E - L N) d + …: columns that no gain acts on count
/// by the sums r of their absolute values.
struct Disturbing {
  Vector r;
  Matrix E, N;
};

Disturbing split(const ErrorDisturbances& d) {
  Disturbing parts{Vector::Zero(d.E.value.rows()), {}, {}};
  std::vector<Index> acted_on;
  for (Index j = 0; j < d.N.value.cols(); ++j) {
    if (d.N.value.col(j).isZero(0)) {
      parts.r += d.E.value.col(j).cwiseAbs();
    } else {
      acted_on.push_back(j);
    }
  }
  parts.E = d.E.value(Eigen::all, acted_on);
  parts.N = d.N.value(Eigen::all, acted_on);
  return parts;
}

double largest_of(MatrixIn A) { return A.size() > 0 ? A.cwiseAbs().maxCoeff() : 0; }

Units units_of(const Matrix& C, const Disturbing& d) {
  const Vector outputs = linalg::row_scales(C);
  Vector sizes(3);
  sizes << largest_of(d.r), largest_of(d.E), largest_of(outputs.asDiagonal() * d.N);
  return {outputs, linalg::row_scales(sizes.transpose())[0]};
}

/// Variables: λ (n), Z (n×p by rows), S (n×q by rows), and a slack per inequality.
struct Program {
  Matrix M;
  Vector b, lower, upper, objective;
};

Program program(const Matrix& A, const Matrix& C, const Disturbing& d) {
  const Index n = A.rows(), p = C.rows(), q = d.N.cols();
  const Index at_S = n + n * p, at_slack = at_S + n * q, rows = n * n + n + 2 * n * q;
  Program made{Matrix::Zero(rows, at_slack + rows), Vector::Zero(rows),
               Vector::Zero(at_slack + rows), Vector::Constant(at_slack + rows, infinity),
               Vector::Zero(at_slack + rows)};
  made.lower.segment(n, n * p).setConstant(-infinity);
  made.objective.head(n) = -d.r;
  made.objective.segment(at_S, n * q).setConstant(-1);
  made.M.rightCols(rows) = -Matrix::Identity(rows, rows);
  Index row = 0;
  for (Index i = 0; i < n; ++i) {  // λ_i A_ij - Z_i C_j ≥ 0
    for (Index j = 0; j < n; ++j, ++row) {
      made.M(row, i) = A(i, j);
      made.M.block(row, n + i * p, 1, p) = -C.col(j).transpose();
    }
  }
  for (Index j = 0; j < n; ++j, ++row) {  // λ_j - Σ_i (λ_i A_ij - Z_i C_j) ≥ 1
    for (Index i = 0; i < n; ++i) {
      made.M(row, i) = -A(i, j);
      made.M.block(row, n + i * p, 1, p) = C.col(j).transpose();
    }
    made.M(row, j) += 1;
    made.b[row] = 1;
  }
  for (Index i = 0; i < n; ++i) {  // S_ij ± (Z_i N_j - λ_i E_ij) ≥ 0
    for (Index j = 0; j < q; ++j) {
      for (const double sign : {1.0, -1.0}) {
        made.M(row, i) = -sign * d.E(i, j);
        made.M(row, at_S + i * q + j) = 1;
        made.M.block(row++, n + i * p, 1, p) = sign * d.N.col(j).transpose();
      }
    }
  }
  return made;
}

/// The lower bound of the least sum by the multipliers y. Where their signs are not those that it
/// needs, a variable x_j costs the bound what it can be worth there: with the least sum at most
/// `value`, c_j x_j ≤ value. Of one that costs nothing only rounding is forgiven; then 0 is a
/// bound.
double dual_bound(const Program& program, const Vector& y, double value) {
  const Vector reduced = program.objective - program.M.transpose() * y;
  const double forgiven = rounding_share * (1 + y.cwiseAbs().maxCoeff());
  double lost = 0;
  for (Index j = 0; j < reduced.size(); ++j) {
    const double wrong = program.lower[j] == 0 ? reduced[j] : std::abs(reduced[j]),
                 cost = -program.objective[j];
    if (!(wrong > 0)) continue;
    if (cost > 0) {
      lost += wrong * (value / cost);
    } else if (!(wrong <= forgiven)) {
      return 0;
    }
  }
  return std::max(0.0, -program.b.dot(y) - lost);
}

struct Optimum {
  Matrix L;
  double value, bound;
};

/// The optimum is a sum of half widths: where it is small beside the largest disturbance, the
/// objective is scaled by it, and solved again.
std::optional<Optimum> optimum_of(const Matrix& A, const Matrix& C, const Disturbing& d) {
  constexpr double small = 1e-2;
  constexpr int rounds = 3;
  const Index n = A.rows(), p = C.rows();
  Units units = units_of(C, d);
  for (int round = 0;; ++round) {
    const Program made = program(A, units.outputs.asDiagonal() * C,
                                 {units.objective * d.r, units.objective * d.E,
                                  units.objective * (units.outputs.asDiagonal() * d.N)});
    const LinearProgram::Solution solution =
        LinearProgram(made.M, made.b, made.lower, made.upper).maximize(made.objective);
    if (solution.status != LinearProgram::Status::optimal) return std::nullopt;
    const double value = -solution.objective;
    if (value > 0 && value < small && round < rounds) {
      units.objective *= std::exp2(-std::ilogb(value));
      continue;
    }
    Matrix L(n, p);
    for (Index i = 0; i < n; ++i)
      L.row(i) = solution.x.segment(n + i * p, p).transpose() / solution.x[i];
    return Optimum{L * units.outputs.asDiagonal(), value / units.objective,
                   dual_bound(made, solution.y, value) / units.objective};
  }
}

/// Σ h of a gain with A - L C ≥ 0.
double sum_of_widths(const Matrix& A, const Matrix& C, const Disturbing& d, const Matrix& L) {
  const Index n = A.rows();
  const Matrix left = d.E - linalg::product(L, d.N);
  const auto h = linalg::solve(Matrix::Identity(n, n) - (A - linalg::product(L, C)),
                               d.r + Vector(left.cwiseAbs().rowwise().sum()));
  return h ? h->sum() : infinity;
}

class Peak final : public FormedDesigner {
 public:
  explicit Peak(std::optional<Matrix> theta) : theta_(std::move(theta)) {}

 private:
  GainDesign do_design(const Model& model, GainForm form) const override {
    const LinearModel& m = model.linear;
    const Matrix C = shown_errors(m, form).value, theta = theta_of(model, theta_);
    Disturbing d;
    try {
      d = split(error_disturbances(model, theta, form));
    } catch (const Error& error) {
      return {Answer::unknown, {}, error.what(), "give bounded sets W and V"};
    }
    const std::string otherwise = std::string("use a designer that does not ask for a monotone ") +
                                  name_of_loop(form) + ", such as \"kalman\"";
    if (auto why = no_monotone_gain(m, form)) {
      return {why->gain_exists, {}, std::move(why->reason), otherwise};
    }
    const std::optional<Optimum> optimum = optimum_of(m.A, C, d);
    if (!optimum) return {Answer::unknown, {}, "the linear program was not solved", otherwise};
    Matrix L = made_monotone(m.A, C, optimum->L);
    if (!is_monotone(m.A, C, L)) {
      return {Answer::unknown,
              {},
              "the gain of the linear program is monotone up to the solver's errors only",
              otherwise};
    }
    if (std::string problem = gain_problem(model, L, form); !problem.empty()) {
      return {Answer::unknown,
              {},
              "the solution of the linear program " + std::move(problem),
              otherwise};
    }
    double sum = sum_of_widths(m.A, C, d, L), value = optimum->value;
    // the solver takes small numbers for nothing: a slow plant may be better off without outputs
    const Matrix none = Matrix::Zero(L.rows(), L.cols());
    if (is_monotone(m.A, C, none) && gain_problem(model, none, form).empty()) {
      const double alone = sum_of_widths(m.A, C, d, none);
      if (alone < sum) {
        L = none;
        value = sum = alone;
      }
    }
    Gain gain;
    gain.certificate = certify(model, L, theta, form);
    gain.certificate.objective = "sum of half widths";
    gain.certificate.optimum = value;
    gain.certificate.optimum_bound = std::min(optimum->bound, sum);
    gain.L = std::move(L);
    return {Answer::yes, std::move(gain)};
  }

  std::optional<Matrix> theta_;
};

std::vector<Diagnostic> check_peak(const GainContext& context, const Params& params) {
  std::vector<Diagnostic> problems;
  check_theta(context.model, params, problems);
  return problems;
}

}  // namespace

CORDON_COMPONENT(gain, peak) {
  ParamSchema schema;
  add_theta_parameter(schema);
  registrar.add(GainEntry{
      {"peak", "least sum of steady widths with A - L C ≥ 0 in every entry; a linear program", "",
       std::move(schema), peak_details},
      check_peak,
      [](const Params& params) { return std::make_unique<Peak>(theta_from(params)); }});
}

}  // namespace cordon::estimators
