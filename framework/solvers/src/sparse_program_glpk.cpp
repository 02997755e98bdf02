// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "cordon/solvers/sparse_program.hpp"
#include "glpk_program.hpp"

namespace cordon {

namespace {

using Solved = LinearProgram::Solution;

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
  glpk::check(program, "sparse program");
  const glpk::Entries A(program);
  const Index m = program.row_lower.size(), n = program.cost.size();
  const int limit = static_cast<int>(std::clamp(seconds, 0.001, 1e6) * 1000);
  Vector x(n), y(m);
  double objective = 0;
  Ended ended;
  const bool whole = glpk::guarded([&] {
    glp_term_out(GLP_OFF);
    glp_prob* const problem = glp_create_prob();
    glpk::load(problem, program, A);
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
  if (!whole || !is_answer(ended)) return solution;
  if (ended.status == GLP_NOFEAS) solution.status = LinearProgram::Status::infeasible;
  if (ended.status == GLP_UNBND) solution.status = LinearProgram::Status::unbounded;
  if (ended.status == GLP_OPT && x.allFinite() && y.allFinite()) {
    solution = {LinearProgram::Status::optimal, std::move(x), std::move(y), objective};
  }
  return solution;
}

}  // namespace cordon
