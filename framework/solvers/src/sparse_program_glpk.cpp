// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "cordon/core/error.hpp"
#include "glpk_environment.hpp"
#include "solvers/sparse_program.hpp"

namespace cordon {

namespace {

using Solved = LinearProgram::Solution;

void require_fine(bool fine, Errc code, const char* what) {
  if (!fine) throw Error(code, std::string("sparse program: ") + what);
}

void require_ordered(const Vector& lower, const Vector& upper) {
  require_fine(!lower.hasNaN() && !upper.hasNaN() && (lower.array() <= upper.array()).all(),
               Errc::not_finite, "a NaN or crossed bound");
}

/// The matrix as GLPK takes it, indices from 1.
struct Triplets {
  std::vector<int> row{0}, col{0};
  std::vector<double> value{0};

  explicit Triplets(const SparseProgram& p) {
    const Index m = p.row_lower.size(), n = p.cost.size();
    require_fine(p.lower.size() == n && p.upper.size() == n && p.row_upper.size() == m,
                 Errc::dimension, "the sizes of cost and bounds differ");
    require_fine(n > 0 && m <= 1'000'000 && n <= 1'000'000, Errc::dimension,
                 "no column, or more than a million rows or columns");
    require_fine(p.cost.allFinite(), Errc::not_finite, "a NaN or infinite cost");
    require_ordered(p.row_lower, p.row_upper);
    require_ordered(p.lower, p.upper);
    for (const auto& [i, j, a] : p.entries) {
      require_fine(i >= 0 && i < m && j >= 0 && j < n, Errc::dimension,
                   "an entry outside of the matrix");
      require_fine(std::isfinite(a), Errc::not_finite, "a NaN or infinite coefficient");
      if (a == 0) continue;
      row.push_back(static_cast<int>(i) + 1);
      col.push_back(static_cast<int>(j) + 1);
      value.push_back(a);
    }
  }
};

void load(glp_prob* problem, const SparseProgram& p, const Triplets& A) {
  const int m = static_cast<int>(p.row_lower.size()), n = static_cast<int>(p.cost.size());
  glp_set_obj_dir(problem, GLP_MIN);
  if (m > 0) glp_add_rows(problem, m);
  glp_add_cols(problem, n);
  for (int i = 0; i < m; ++i) {
    glp_set_row_bnds(problem, i + 1, glpk::bound_type(p.row_lower[i], p.row_upper[i]),
                     p.row_lower[i], p.row_upper[i]);
  }
  for (int j = 0; j < n; ++j) {
    glp_set_col_bnds(problem, j + 1, glpk::bound_type(p.lower[j], p.upper[j]), p.lower[j],
                     p.upper[j]);
    glp_set_obj_coef(problem, j + 1, p.cost[j]);
  }
  glp_load_matrix(problem, static_cast<int>(A.value.size()) - 1, A.row.data(), A.col.data(),
                  A.value.data());
}

/// GLPK's code and the status of the basis.
struct Ended {
  int code = -1, status = GLP_UNDEF;
};

Ended run_simplex(glp_prob* problem, int method, bool presolved, int milliseconds) {
  glp_smcp control;
  glp_init_smcp(&control);
  control.msg_lev = GLP_MSG_OFF;
  control.meth = method;
  control.presolve = presolved ? GLP_ON : GLP_OFF;
  control.tm_lim = milliseconds;
  const int code = glp_simplex(problem, &control);
  if (code == GLP_ENOPFS) return {0, GLP_NOFEAS};
  if (code == GLP_ENODFS) return {0, GLP_UNBND};
  return {code, glp_get_status(problem)};
}

bool is_answer(const Ended& ended) {
  return ended.code == 0 &&
         (ended.status == GLP_OPT || ended.status == GLP_NOFEAS || ended.status == GLP_UNBND);
}

}  // namespace

Solved minimize(const SparseProgram& program, double seconds) {
  const Triplets A(program);
  const Index m = program.row_lower.size(), n = program.cost.size();
  const int limit = static_cast<int>(std::clamp(seconds, 0.001, 1e6) * 1000);
  Vector x(n), y(m);
  double objective = 0;
  Ended ended;
  glpk::guarded([&] {
    glp_term_out(GLP_OFF);
    glp_prob* const problem = glp_create_prob();
    load(problem, program, A);
    // What presolving leaves may have no digits; it is many times faster where it has.
    const std::pair<int, bool> attempts[] = {
        {GLP_DUALP, true}, {GLP_DUALP, false}, {GLP_PRIMAL, false}};
    for (const auto& [method, presolved] : attempts) {
      if (!presolved) glp_std_basis(problem);
      ended = run_simplex(problem, method, presolved, limit);
      if (is_answer(ended) || ended.code == GLP_ETMLIM) break;
    }
    for (Index j = 0; j < n; ++j) x[j] = glp_get_col_prim(problem, static_cast<int>(j) + 1);
    for (Index i = 0; i < m; ++i) y[i] = glp_get_row_dual(problem, static_cast<int>(i) + 1);
    objective = glp_get_obj_val(problem);
    glp_delete_prob(problem);
  });
  Solved solution;
  if (!is_answer(ended)) return solution;
  if (ended.status == GLP_NOFEAS) solution.status = LinearProgram::Status::infeasible;
  if (ended.status == GLP_UNBND) solution.status = LinearProgram::Status::unbounded;
  if (ended.status == GLP_OPT && x.allFinite() && y.allFinite()) {
    solution = {LinearProgram::Status::optimal, std::move(x), std::move(y), objective};
  }
  return solution;
}

}  // namespace cordon
