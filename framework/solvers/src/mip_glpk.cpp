// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <exception>
#include <string>

#include "cordon/core/error.hpp"
#include "cordon/solvers/mip.hpp"
#include "glpk_environment.hpp"

namespace cordon {

using glpk::bound_type;
using glpk::guarded;

namespace {

using Clock = std::chrono::steady_clock;

void require(bool fine, Errc code, const char* what) {
  if (!fine) throw Error(code, std::string("mixed-integer program: ") + what);
}

bool ordered(const Vector& lower, const Vector& upper) {
  return !lower.hasNaN() && !upper.hasNaN() && (lower.array() <= upper.array()).all() &&
         (lower.array() < infinity).all() && (upper.array() > -infinity).all();
}

void check(const MixedIntegerProgram& p, const MipOptions& options) {
  const Index n = p.cost.size(), m = p.row_lower.size();
  require(p.lower.size() == n && p.upper.size() == n && static_cast<Index>(p.integer.size()) == n &&
              p.row_upper.size() == m,
          Errc::dimension, "the sizes of cost, bounds and kinds differ");
  require(n > 0, Errc::dimension, "no column");
  require(m <= 1'000'000 && n <= 1'000'000 && p.entries.size() <= 50'000'000, Errc::dimension,
          "more than a million rows or columns");
  require(p.cost.allFinite(), Errc::not_finite, "a NaN or infinite cost");
  require(ordered(p.row_lower, p.row_upper) && ordered(p.lower, p.upper), Errc::not_finite,
          "a NaN or crossed bound");
  std::vector<std::pair<Index, Index>> places;
  places.reserve(p.entries.size());
  for (const auto& [row, col, value] : p.entries) {
    require(row >= 0 && row < m && col >= 0 && col < n, Errc::dimension,
            "an entry outside of the matrix");
    require(std::isfinite(value), Errc::not_finite, "a NaN or infinite coefficient");
    places.emplace_back(row, col);
  }
  std::sort(places.begin(), places.end());
  require(std::adjacent_find(places.begin(), places.end()) == places.end(), Errc::invalid,
          "two entries at one place");
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

/// The program as GLPK takes it, indices from 1.
struct Arrays {
  std::vector<int> row{0}, col{0};
  std::vector<double> value{0};

  explicit Arrays(const MixedIntegerProgram& p) {
    for (const auto& entry : p.entries) {
      if (entry.value == 0) continue;
      row.push_back(static_cast<int>(entry.row) + 1);
      col.push_back(static_cast<int>(entry.col) + 1);
      value.push_back(entry.value);
    }
  }
};

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

void load(glp_prob* problem, const MixedIntegerProgram& p, const Arrays& arrays) {
  const int m = static_cast<int>(p.row_lower.size()), n = static_cast<int>(p.cost.size());
  glp_set_obj_dir(problem, GLP_MIN);
  if (m > 0) glp_add_rows(problem, m);
  glp_add_cols(problem, n);
  for (int i = 0; i < m; ++i) {
    glp_set_row_bnds(problem, i + 1, bound_type(p.row_lower[i], p.row_upper[i]), p.row_lower[i],
                     p.row_upper[i]);
  }
  for (int j = 0; j < n; ++j) {
    glp_set_col_bnds(problem, j + 1, bound_type(p.lower[j], p.upper[j]), p.lower[j], p.upper[j]);
    glp_set_obj_coef(problem, j + 1, p.cost[j]);
    if (p.integer[static_cast<std::size_t>(j)]) glp_set_col_kind(problem, j + 1, GLP_IV);
  }
  glp_load_matrix(problem, static_cast<int>(arrays.value.size()) - 1, arrays.row.data(),
                  arrays.col.data(), arrays.value.data());
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
  const Arrays arrays(program);
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
    load(problem, program, arrays);
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
