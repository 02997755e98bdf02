// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "cordon/core/error.hpp"
#include "cordon/solvers/limits.hpp"
#include "cordon/solvers/lp.hpp"
#include "glpk_environment.hpp"

namespace cordon {

using glpk::bound_type;
using glpk::environment;
using glpk::guarded;

namespace {

void require_number(bool fine, const char* what) {
  if (!fine) throw Error(Errc::not_finite, std::string("linear program: ") + what);
}

}  // namespace

struct LinearProgram::State {
  glp_prob* problem = nullptr;
  unsigned born = 0;  ///< the environment the problem lives in
  Index rows = 0, cols = 0;

  std::thread::id home = std::this_thread::get_id();  ///< GLPK's memory belongs to a thread

  /// On another thread the problem cannot be touched: solves fail there, which is no answer.
  bool alive() const {
    return problem != nullptr && born == environment && home == std::this_thread::get_id();
  }
  ~State() {
    if (alive()) guarded([this] { glp_delete_prob(problem); });
  }
};

LinearProgram::LinearProgram(LinearProgram&&) noexcept = default;
LinearProgram& LinearProgram::operator=(LinearProgram&&) noexcept = default;
LinearProgram::~LinearProgram() = default;

LinearProgram::LinearProgram(MatrixIn A, VectorIn b, VectorIn lower, VectorIn upper)
    : state_(std::make_unique<State>()) {
  const Index m = A.rows(), n = A.cols();
  if (b.size() != m || lower.size() != n || upper.size() != n) {
    throw Error(Errc::dimension,
                "linear program: the sizes of matrix, right-hand side and bounds differ");
  }
  if (m > 1'000'000 || n > 1'000'000)
    throw Error(Errc::dimension, "linear program: more than a million rows or columns");
  require_number(A.allFinite() && b.allFinite(), "a NaN or infinite coefficient");
  require_number(!lower.hasNaN() && !upper.hasNaN() && (lower.array() <= upper.array()).all(),
                 "a NaN or crossed bound");
  std::vector<int> row{0}, col{0};
  std::vector<double> value{0};
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < m; ++i) {
      if (A(i, j) == 0) continue;
      row.push_back(static_cast<int>(i) + 1);
      col.push_back(static_cast<int>(j) + 1);
      value.push_back(A(i, j));
    }
  }
  State& s = *state_;
  s.rows = m;
  s.cols = n;
  guarded([&] {
    glp_term_out(GLP_OFF);
    s.problem = glp_create_prob();
    s.born = environment;
    glp_set_obj_dir(s.problem, GLP_MAX);
    if (m > 0) glp_add_rows(s.problem, static_cast<int>(m));
    if (n > 0) glp_add_cols(s.problem, static_cast<int>(n));
    for (Index i = 0; i < m; ++i)
      glp_set_row_bnds(s.problem, static_cast<int>(i) + 1, GLP_FX, b[i], b[i]);
    for (Index j = 0; j < n; ++j) {
      glp_set_col_bnds(s.problem, static_cast<int>(j) + 1, bound_type(lower[j], upper[j]), lower[j],
                       upper[j]);
    }
    glp_load_matrix(s.problem, static_cast<int>(value.size()) - 1, row.data(), col.data(),
                    value.data());
  });
}

LinearProgram::Solution LinearProgram::maximize(VectorIn g) {
  State& s = *state_;
  if (g.size() != s.cols)
    throw Error(Errc::dimension, "linear program: the objective has the wrong size");
  require_number(g.allFinite(), "a NaN or infinite objective");
  Solution solution;
  if (!s.alive() || !LimitedSolvers::may_begin()) return solution;
  Vector x(s.cols), y(s.rows);
  int code = -1, status = GLP_UNDEF;
  guarded([&] {
    for (Index j = 0; j < s.cols; ++j) glp_set_obj_coef(s.problem, static_cast<int>(j) + 1, g[j]);
    glp_smcp control;
    glp_init_smcp(&control);
    control.msg_lev = GLP_MSG_OFF;
    control.it_lim = static_cast<int>(std::min<Index>(1'000'000, 1000 + 100 * (s.rows + s.cols)));
    control.tm_lim = LimitedSolvers::milliseconds_left(std::numeric_limits<int>::max());
    // With boxed variables every basis is dual feasible: the dual method needs no first phase,
    // whatever the last direction was.
    control.meth = GLP_DUALP;
    code = glp_simplex(s.problem, &control);
    if (code == GLP_ETMLIM) LimitedSolvers::tell_left_open(true);
    status = glp_get_status(s.problem);
    if (code != GLP_ETMLIM && !LimitedSolvers::is_over() &&
        (code != 0 || status == GLP_UNDEF || status == GLP_INFEAS)) {
      glp_std_basis(s.problem);
      control.meth = GLP_PRIMAL;
      control.tm_lim = LimitedSolvers::milliseconds_left(std::numeric_limits<int>::max());
      code = glp_simplex(s.problem, &control);
      if (code == GLP_ETMLIM) LimitedSolvers::tell_left_open(true);
      status = glp_get_status(s.problem);
    }
    if (code != 0 || status != GLP_OPT) return;
    for (Index j = 0; j < s.cols; ++j) x[j] = glp_get_col_prim(s.problem, static_cast<int>(j) + 1);
    for (Index i = 0; i < s.rows; ++i) y[i] = glp_get_row_dual(s.problem, static_cast<int>(i) + 1);
    solution.objective = glp_get_obj_val(s.problem);
  });
  if (!s.alive() || code != 0) return solution;
  if (status == GLP_NOFEAS) solution.status = Status::infeasible;
  if (status == GLP_UNBND) solution.status = Status::unbounded;
  if (status == GLP_OPT && x.allFinite() && y.allFinite()) {
    solution.status = Status::optimal;
    solution.x = std::move(x);
    solution.y = std::move(y);
  }
  return solution;
}

}  // namespace cordon
