// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/milp/search.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "cordon/core/linalg.hpp"
#include "designers/milp/local_search.hpp"
#include "designers/milp/pair_reduction.hpp"
#include "designers/milp/program.hpp"

namespace cordon::designers {

namespace {

constexpr double share_of_starts = .1, share_of_single_pairs = .2,
                 share_of_first_start = .5;  ///< of the time limit, ends of these parts
constexpr double kappa_tolerance = 1e-6;     ///< of κ, for the solvers
constexpr double zero = 1e-9;                ///< multipliers below are 0
constexpr double closed_programs =
    1e-9;  ///< a quadratic cost is met where tangents miss it by this share

class MilpSearch {
 public:
  MilpSearch(const SeparationProblem& problem, const MilpLimits& limits, DesignControl& control)
      : problem_(problem),
        limits_(limits),
        control_(control),
        begin_(std::chrono::steady_clock::now()) {}

  SearchResult run() {
    if (!reduce()) return std::move(result_);
    result_.restriction = RestrictedProblem{
        fmt::format("the program with at most {} generators per pair, as GLPK bounds it",
                    limits_.max_generators),
        -infinity};
    LocalSearch local(problem_, pairs_, [this] { return left_to_start(); });
    look_for_starts(local);
    InputProgram inputs(problem_);
    if (result_.u) inputs.limit_cost(result_.cost);
    inputs.add_tangents_between();
    if (result_.u) inputs.add_tangents(*result_.u);
    const std::vector<double> most = largest_kappas(local, inputs);
    if (bound_single_pairs(inputs, most)) branch(std::move(inputs), most);
    result_.programs += local.programs();
    conclude();
    return std::move(result_);
  }

 private:
  /// Seconds until this share of the time limit is over; 0 if the search was ended from outside.
  double left(double share) const {
    if (control_.stop()) return 0;
    return share * limits_.time_limit -
           std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

  /// The first input is worth more of the time than better ones.
  double left_to_start() const { return left(result_.u ? share_of_starts : share_of_first_start); }

  /// What is known of the reduced program's optimum, which is no bound of the problem itself.
  double bound() const { return result_.restriction->lower_bound; }
  void raise_bound(double bound) {
    result_.restriction->lower_bound = std::max(this->bound(), bound);
  }

  bool reduce();
  bool settled(const PairProgram& pair);
  void look_for_starts(LocalSearch& local);
  std::vector<double> largest_kappas(LocalSearch& local, const InputProgram& inputs) const;
  bool bound_single_pairs(InputProgram& inputs, const std::vector<double>& most);
  void branch(InputProgram whole, const std::vector<double>& most);
  std::optional<Vector> start(const InputProgram& whole, const std::vector<PairColumns>& columns);
  MipOptions options(double share, const std::vector<PairColumns>& columns) const;
  void offer(const Vector& u);
  void conclude();

  const SeparationProblem& problem_;
  const MilpLimits& limits_;
  DesignControl& control_;
  std::chrono::steady_clock::time_point begin_;
  std::vector<PairProgram> pairs_;  ///< reduced, those first that cost most alone
  std::vector<std::size_t> order_;  ///< of `pairs_`, in which their sides are branched on
  SearchResult result_;
  bool closed_ = false, impossible_ = false, unproven_ = false;
};

/// A pair that no input changes. True: it is apart whatever the input is.
bool MilpSearch::settled(const PairProgram& pair) {
  const InputSequences& U = problem_.U;
  Vector u = U.c;
  if (U.b.size() > 0) u += linalg::product(U.G, linalg::product(linalg::pseudo_inverse(U.A), U.b));
  const PairSeparation apart = separation(pair, u);
  if (apart.disjoint == Answer::yes && apart.kappa >= problem_.epsilon) return true;
  const bool untouched = (pair.N.array() == 0).all() &&
                         (pair.N_magnitude.array() == 0).all();  // by inputs, not just by rounding
  const bool exactly = untouched && apart.disjoint == Answer::no;
  result_.status = exactly ? DesignStatus::infeasible : DesignStatus::unknown;
  const std::string pair_name = modes_of(problem_, pair);
  result_.reason =
      exactly ? fmt::format(
                    "no input changes how far the outputs of {} are apart, and that is not "
                    "enough (κ = {:.4g})",
                    pair_name, apart.kappa)
              : fmt::format(
                    "what inputs change between the outputs of {} is not told from "
                    "rounding (κ = {:.4g} without it)",
                    pair_name, apart.kappa);
  result_.suggestion = "a longer horizon";
  return false;
}

bool MilpSearch::reduce() {
  for (const PairProgram& pair : problem_.pairs) {
    if (pair.rows() > 0) continue;
    if (pair.vanished > 0) {
      result_.reason =
          fmt::format("{} differ by less than rounding allows to tell", modes_of(problem_, pair));
      return false;
    }
    result_.status = DesignStatus::infeasible;
    result_.reason = fmt::format(
        "the outputs of {} can be the same under every input: no equation is left that could fail",
        modes_of(problem_, pair));
    result_.suggestion = "a longer horizon";
    return false;
  }
  for (const PairProgram& pair : problem_.pairs) {
    if (left(1) <= 0) {
      conclude();
      return false;
    }
    if (!inputs_enter(pair, problem_.U)) {
      if (!settled(pair)) return false;
      continue;
    }
    std::optional<PairProgram> reduced =
        reduce_pair(pair, problem_.U, limits_.max_generators, limits_.max_constraints);
    if (!reduced) {
      result_.reason = fmt::format(
          "{} generators cannot enclose the difference of {}, which the inputs enter in more "
          "dimensions",
          limits_.max_generators, modes_of(problem_, pair));
      result_.suggestion = "a larger \"max_generators\"";
      return false;
    }
    pairs_.push_back(std::move(*reduced));
  }
  return true;
}

/// Takes u if it is cheaper and proven to separate the pairs themselves (without ε they may touch).
void MilpSearch::offer(const Vector& u) {
  const double cost = problem_.cost.at(u);
  if (result_.u && !(cost < result_.cost)) return;
  for (const PairProgram& pair : problem_.pairs) {
    if (control_.stop()) return;
    const PairSeparation apart = separation(pair, u);
    const bool proven = apart.disjoint == Answer::yes || problem_.epsilon == 0;
    if (proven && apart.kappa >= problem_.epsilon - kappa_tolerance) continue;
    unproven_ = true;
    return;
  }
  result_.u = u;
  result_.cost = cost;
  control_.progress(problem_.horizon, cost, -infinity);
}

void MilpSearch::look_for_starts(LocalSearch& local) {
  std::mt19937_64 engine(1);
  const Index g = problem_.U.G.cols(), most = 8 * g + 32, most_in_vain = 4 * g + 16;
  for (Index k = 0, in_vain = 0; k < most && in_vain < most_in_vain && left_to_start() > 0; ++k) {
    const double before = result_.u ? result_.cost : infinity;
    Vector corner(g);
    for (double& entry : corner) entry = (engine() >> 32) % 2 == 0 ? -1 : 1;
    if (const auto u = local.from(problem_.U.c + linalg::product(problem_.U.G, corner))) offer(*u);
    in_vain = result_.u && result_.cost < before ? 0 : in_vain + 1;
  }
}

std::vector<double> MilpSearch::largest_kappas(LocalSearch& local,
                                               const InputProgram& inputs) const {
  std::vector<double> most;
  for (std::size_t q = 0; q < pairs_.size(); ++q) {
    const double kappa =
        local.largest_kappa(q, inputs.lower(), inputs.upper(), result_.u ? result_.cost : infinity);
    most.push_back(std::max(kappa, problem_.epsilon));
  }
  return most;
}

MipOptions MilpSearch::options(double share, const std::vector<PairColumns>& columns) const {
  MipOptions options;
  options.time_limit = left(share);
  options.gap = limits_.gap;
  options.cuts = false;  // they cost more here than they save
  for (const PairColumns& pair : columns) {
    for (Index j = 0; j < pair.generators; ++j) {
      options.branching.push_back(pair.first + j);
      options.branching.push_back(pair.first + pair.generators + j);
    }
  }
  options.watch = [this](double, double) { return control_.stop(); };
  return options;
}

/// What each pair alone costs bounds the whole, and says which pair to branch on first. False: one
/// has no solution.
bool MilpSearch::bound_single_pairs(InputProgram& inputs, const std::vector<double>& most) {
  std::vector<double> alone(pairs_.size(), -infinity);
  for (std::size_t q = 0; q < pairs_.size(); ++q) {
    order_.push_back(q);
    InputProgram one = inputs;
    const std::vector<PairColumns> columns{add_pair(one, pairs_[q], problem_.epsilon, most[q])};
    const MipSolution solution = solve(one.program(), options(share_of_single_pairs, columns));
    result_.nodes += solution.nodes;
    if (solution.status == MipStatus::infeasible && !result_.u) {
      impossible_ = true;
      return false;
    }
    alone[q] = std::isfinite(solution.bound) ? solution.bound : 0;
    raise_bound(alone[q]);
  }
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::size_t a, std::size_t b) { return alone[a] > alone[b]; });
  if (bound() > 0) inputs.demand_cost(bound() * (1 - kappa_tolerance));
  control_.progress(problem_.horizon, result_.u ? result_.cost : infinity, -infinity);
  return true;
}

void MilpSearch::branch(InputProgram whole, const std::vector<double>& most) {
  std::vector<PairColumns> columns(pairs_.size());
  for (std::size_t q = 0; q < pairs_.size(); ++q)
    columns[q] = add_pair(whole, pairs_[q], problem_.epsilon, most[q]);
  std::vector<PairColumns> ordered;
  for (const std::size_t q : order_) ordered.push_back(columns[q]);
  while (left(1) > 0) {
    MipOptions limits = options(1, ordered);
    if (result_.u) limits.start = start(whole, columns);
    limits.watch = [this](double best, double) {
      const double known = result_.u ? result_.cost : infinity;
      control_.progress(problem_.horizon, std::min(best, known), -infinity);
      return control_.stop();
    };
    const MipSolution solution = solve(whole.program(), limits);
    result_.nodes += solution.nodes;
    impossible_ = solution.status == MipStatus::infeasible && !result_.u;
    if (std::isfinite(solution.bound)) raise_bound(solution.bound);
    if (solution.x.size() == 0) return;
    const Vector u = solution.x.head(whole.inputs());
    offer(u);
    if (solution.status != MipStatus::optimal) return;
    closed_ = problem_.cost.at(u) - solution.objective <=
              std::max(limits_.gap, closed_programs) * problem_.cost.at(u);
    if (closed_) return;
    whole.add_tangents(u);
  }
}

/// All columns for the input that is known: its sides are those that the multipliers of every pair
/// tell, the rest is linear.
std::optional<Vector> MilpSearch::start(const InputProgram& whole,
                                        const std::vector<PairColumns>& columns) {
  MixedIntegerProgram fixed = whole.program();
  fixed.lower.head(whole.inputs()) = fixed.upper.head(whole.inputs()) = *result_.u;
  for (std::size_t q = 0; q < pairs_.size(); ++q) {
    const auto apart =
        Gauge(pairs_[q].G).at(linalg::product(pairs_[q].N, *result_.u) - pairs_[q].c);
    if (!apart) return std::nullopt;
    const Vector mu = linalg::product(pairs_[q].G.transpose(), apart->lambda);
    for (Index j = 0; j < mu.size(); ++j) {
      const Index p_1 = columns[q].first + j, p_2 = p_1 + mu.size();
      fixed.lower[p_1] = fixed.upper[p_1] = mu[j] > zero ? 1 : 0;
      fixed.lower[p_2] = fixed.upper[p_2] = mu[j] < -zero ? 1 : 0;
    }
  }
  MipSolution solution = solve(fixed, options(1, {}));
  result_.programs += 1 + static_cast<std::int64_t>(pairs_.size());
  if (solution.status != MipStatus::optimal) return std::nullopt;
  return std::move(solution.x);
}

void MilpSearch::conclude() {
  result_.stopped = !closed_ && !impossible_ && left(1) <= 0;
  const std::string ended =
      control_.stop() ? "the search was ended from outside" : "the time limit is over";
  if (result_.u) {
    result_.status = DesignStatus::feasible;
    if (bound() > result_.cost) result_.restriction->lower_bound = result_.cost;
    result_.reason = closed_ ? "this is the optimum of the program after its reduction, as GLPK "
                               "says; an input that costs less "
                               "may separate the modes too"
                     : result_.stopped ? ended
                                       : "GLPK ended without an optimum";
    result_.suggestion = closed_
                             ? "\"facets\" for a proven optimum"
                             : "fewer generators are faster; \"facets\" needs none to be reduced";
    return;
  }
  result_.status = DesignStatus::unknown;
  result_.suggestion = "more generators, or \"facets\", which needs none to be reduced";
  if (impossible_) {
    result_.reason =
        "the program has no solution after its reduction, as GLPK says; the problem itself may "
        "have one";
    result_.restriction->lower_bound = -infinity;
  } else if (unproven_) {
    result_.reason = "an input was found, but that it separates the modes is not proven";
  } else {
    result_.reason =
        result_.stopped ? "no input was found: " + ended : "GLPK ended without an answer";
  }
}

}  // namespace

SearchResult search_milp(const SeparationProblem& problem, const MilpLimits& limits,
                         DesignControl& control) {
  return MilpSearch(problem, limits, control).run();
}

}  // namespace cordon::designers
