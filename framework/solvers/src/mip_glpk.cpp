// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <exception>
#include <string>

#include "cordon/core/error.hpp"
#include "cordon/solvers/mip.hpp"
#include "glpk_program.hpp"

namespace cordon {

using glpk::guarded;

namespace {

using Clock = std::chrono::steady_clock;

void require(bool fine, Errc code, const char* what) {
  if (!fine) throw Error(code, std::string("mixed-integer program: ") + what);
}

void check(const MixedIntegerProgram& p, const MipOptions& options) {
  glpk::check(p, "mixed-integer program");
  const Index n = p.cost.size();
  require(static_cast<Index>(p.integer.size()) == n, Errc::dimension,
          "the sizes of cost and kinds differ");
  for (Index j = 0; j < n; ++j) {
    if (!p.integer[static_cast<std::size_t>(j)]) continue;
    require(std::isfinite(p.lower[j]) && std::isfinite(p.upper[j]) &&
                p.lower[j] == std::floor(p.lower[j]) && p.upper[j] == std::floor(p.upper[j]),
            Errc::invalid, "a whole number whose bounds are not");
  }
  require(!std::isnan(options.time_limit) && options.gap >= 0, Errc::invalid,
          "a time limit or gap that is no number");
  require(!options.start || options.start->size() == n, Errc::dimension, "a start of another size");
  for (const Index column : options.branching) {
    require(column >= 0 && column < n && p.integer[static_cast<std::size_t>(column)], Errc::invalid,
            "a column to branch on that is not whole");
  }
}

/// Does x satisfy the program up to 1e-6 of each row's terms?
bool satisfies(const MixedIntegerProgram& p, const Vector& x) {
  if (!x.allFinite()) return false;
  constexpr double tolerance = 1e-6;
  Vector value = Vector::Zero(p.row_lower.size()), terms = Vector::Ones(p.row_lower.size());
  for (const auto& [row, col, coefficient] : p.entries) {
    value[row] += coefficient * x[col];
    terms[row] += std::abs(coefficient * x[col]);
  }
  const auto within = [&](double v, double lower, double upper, double size) {
    return v >= lower - tolerance * size && v <= upper + tolerance * size;
  };
  for (Index i = 0; i < value.size(); ++i) {
    if (!within(value[i], p.row_lower[i], p.row_upper[i], terms[i])) return false;
  }
  for (Index j = 0; j < x.size(); ++j) {
    if (!within(x[j], p.lower[j], p.upper[j], 1 + std::abs(x[j]))) return false;
    if (p.integer[static_cast<std::size_t>(j)] && x[j] != std::round(x[j])) return false;
  }
  return true;
}

/// What the search tells while it runs.
struct Search {
  const MipOptions* options;
  std::vector<double> start;  ///< from index 1; empty: none, or handed over
  double best = infinity, bound = -infinity;
  std::int64_t nodes = 0;
  bool stopped = false;
  std::exception_ptr thrown;
};

void call_back(glp_tree* tree, void* info) {
  Search& search = *static_cast<Search*>(info);
  if (!search.start.empty() && glp_ios_reason(tree) == GLP_IHEUR) {
    glp_ios_heur_sol(tree, search.start.data());
    search.start.clear();
  }
  int total = 0;
  glp_ios_tree_size(tree, nullptr, nullptr, &total);
  search.nodes = total;
  if (glp_ios_reason(tree) == GLP_IBRANCH) {
    for (const Index column : search.options->branching) {
      if (glp_ios_can_branch(tree, static_cast<int>(column) + 1) == 0) continue;
      glp_ios_branch_upon(tree, static_cast<int>(column) + 1, GLP_UP_BRNCH);
      break;
    }
  }
  glp_prob* const problem = glp_ios_get_prob(tree);
  if (glp_mip_status(problem) == GLP_FEAS) search.best = glp_mip_obj_val(problem);
  if (const int node = glp_ios_best_node(tree); node != 0) {
    search.bound = std::max(search.bound, std::min(glp_ios_node_bound(tree, node), search.best));
  }
  if (!search.options->watch || search.stopped) return;
  try {
    search.stopped = search.options->watch(search.best, search.bound);
  } catch (...) {
    search.thrown = std::current_exception();
    search.stopped = true;
  }
  if (search.stopped) glp_ios_terminate(tree);
}

void load(glp_prob* problem, const MixedIntegerProgram& p, const glpk::Entries& entries) {
  glpk::load(problem, p, entries);
  for (Index j = 0; j < p.cost.size(); ++j) {
    if (p.integer[static_cast<std::size_t>(j)])
      glp_set_col_kind(problem, static_cast<int>(j) + 1, GLP_IV);
  }
  glp_scale_prob(problem, GLP_SF_AUTO);
}

/// The relaxation, by the dual method, by the primal one where that fails.
int relax(glp_prob* problem, int milliseconds) {
  glp_smcp control;
  glp_init_smcp(&control);
  control.msg_lev = GLP_MSG_OFF;
  control.tm_lim = milliseconds;
  control.meth = GLP_DUALP;
  int code = glp_simplex(problem, &control);
  if (code != 0 && code != GLP_ETMLIM) {
    glp_std_basis(problem);
    control.meth = GLP_PRIMAL;
    code = glp_simplex(problem, &control);
  }
  return code;
}

int branch_and_cut(glp_prob* problem, int milliseconds, Search& search) {
  glp_iocp control;
  glp_init_iocp(&control);
  control.msg_lev = GLP_MSG_OFF;
  control.tm_lim = milliseconds;
  control.mip_gap = search.options->gap;
  if (search.options->cuts)
    control.gmi_cuts = control.mir_cuts = control.cov_cuts = control.clq_cuts = GLP_ON;
  control.cb_func = call_back;
  control.cb_info = &search;
  return glp_intopt(problem, &control);
}

}  // namespace

MipSolution solve(const MixedIntegerProgram& program, const MipOptions& options) {
  check(program, options);
  MipSolution solution;
  const auto begin = Clock::now();
  const auto milliseconds_left = [&] {
    const double left =
        1e3 * (options.time_limit - std::chrono::duration<double>(Clock::now() - begin).count());
    return static_cast<int>(std::clamp(left, 1.0, 1e9));
  };
  const glpk::Entries entries(program);
  Search search{&options, {}, infinity, -infinity, 0, false, nullptr};
  const bool start = options.start && satisfies(program, *options.start);
  if (start) {
    search.start.assign(1, 0);
    search.start.insert(search.start.end(), options.start->begin(), options.start->end());
  }
  Vector x(program.cost.size());
  int code = GLP_EFAIL, relaxed = GLP_UNDEF, status = GLP_UNDEF;
  const bool whole = guarded([&] {
    glp_term_out(GLP_OFF);
    glp_prob* const problem = glp_create_prob();
    load(problem, program, entries);
    code = options.time_limit > 0 ? relax(problem, milliseconds_left()) : GLP_ETMLIM;
    relaxed = glp_get_status(problem);
    if (code == 0 && relaxed == GLP_OPT) {
      code = branch_and_cut(problem, milliseconds_left(), search);
      status = glp_mip_status(problem);
      for (Index j = 0; j < x.size(); ++j) x[j] = glp_mip_col_val(problem, static_cast<int>(j) + 1);
    }
    glp_delete_prob(problem);
  });
  if (search.thrown) std::rethrow_exception(search.thrown);
  if (!whole) return solution;
  solution.nodes = search.nodes;
  solution.bound = search.bound;
  const bool found = (status == GLP_OPT || status == GLP_FEAS) && x.allFinite();
  const bool ended = code == GLP_ETMLIM || code == GLP_ESTOP;
  if (relaxed == GLP_NOFEAS || (code == 0 && status == GLP_NOFEAS)) {
    solution.status = MipStatus::infeasible;
    solution.bound = infinity;
  } else if (found) {
    const bool closed = (code == 0 && status == GLP_OPT) || code == GLP_EMIPGAP;
    solution.status = closed ? MipStatus::optimal : MipStatus::feasible;
    solution.x = x;
    for (Index j = 0; j < x.size(); ++j) {
      if (program.integer[static_cast<std::size_t>(j)]) solution.x[j] = std::round(x[j]);
    }
    solution.objective = program.cost.dot(solution.x);
    if (code == 0 && closed) solution.bound = solution.objective;
  } else if (ended) {
    solution.status = start ? MipStatus::feasible : MipStatus::limit;
    if (start) solution.x = *options.start;
    if (start) solution.objective = program.cost.dot(solution.x);
  }
  return solution;
}

}  // namespace cordon
