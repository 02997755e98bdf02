// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/milp/local_search.hpp"

#include <cmath>
#include <limits>

#include "cordon/core/linalg.hpp"

namespace cordon::designers {

namespace {

constexpr int most_rounds = 50;         ///< of normals, and of tangents
constexpr double near = 1e-5;           ///< a quadratic cost is met up to this share
constexpr Index most_free_inputs = 10;  ///< whose box's vertices are enumerated
constexpr double margin = 1e-6;         ///< of κ, for the solver's tolerance

}  // namespace

LocalSearch::LocalSearch(const SeparationProblem& problem, const std::vector<PairProgram>& pairs,
                         std::function<double()> seconds_left)
    : problem_(problem), pairs_(pairs), seconds_left_(std::move(seconds_left)), inputs_(problem) {
  inputs_.add_tangents_between();
  for (const PairProgram& pair : pairs) gauges_.emplace_back(pair.G);
}

std::optional<Vector> LocalSearch::cheapest(InputProgram program) {
  std::optional<Vector> best;
  for (int round = 0; round < most_rounds; ++round) {
    MipOptions options;
    options.time_limit = seconds_left_();
    if (options.time_limit <= 0) return best;
    const MipSolution solution = solve(program.program(), options);
    ++programs_;
    if (solution.status != MipStatus::optimal) return best;
    const Vector u = solution.x.head(program.inputs());
    const double cost = problem_.cost.at(u);
    if (!best || cost < problem_.cost.at(*best)) best = u;
    if (cost - solution.objective <= near * cost) return best;
    program.add_tangents(u);
  }
  return best;
}

std::optional<Vector> LocalSearch::from(Vector u) {
  std::optional<Vector> best;
  for (int round = 0; round < most_rounds; ++round) {
    InputProgram program = inputs_;
    for (std::size_t q = 0; q < pairs_.size(); ++q) {
      if (seconds_left_() <= 0) return best;
      const auto apart = gauges_[q].at(linalg::product(pairs_[q].N, u) - pairs_[q].c);
      ++programs_;
      if (!apart) return best;
      program.add_row(Vector(linalg::product(pairs_[q].N.transpose(), apart->lambda)),
                      1 + problem_.epsilon + apart->lambda.dot(pairs_[q].c), infinity);
    }
    std::optional<Vector> next = cheapest(std::move(program));
    if (!next) return best;
    const bool cheaper = !best || problem_.cost.at(*next) < problem_.cost.at(*best) * (1 - 1e-9);
    if (!cheaper) return best;
    u = *next;
    best = std::move(next);
  }
  return best;
}

double LocalSearch::gauge(std::size_t q, const Vector& z) {
  ++programs_;
  const auto apart = gauges_[q].at(z);
  return apart ? apart->value : infinity;
}

double LocalSearch::largest_kappa(std::size_t q, const Vector& lower, const Vector& upper,
                                  double cost) {
  const PairProgram& pair = pairs_[q];
  const Cost& J = problem_.cost;
  const Vector middle = (lower + upper) / 2, radius = (upper - lower) / 2;
  std::vector<Index> entering;  // the inputs that are free and enter this pair
  for (Index i = 0; i < radius.size(); ++i) {
    if (radius[i] > 0 && (pair.N.col(i).array() != 0).any()) entering.push_back(i);
  }
  const auto free = static_cast<Index>(entering.size());
  double most = 0;
  if (free <= most_free_inputs) {
    for (Index vertex = 0; vertex < Index{1} << free; ++vertex) {
      Vector u = middle;
      for (Index k = 0; k < free; ++k) {
        const Index i = entering[static_cast<std::size_t>(k)];
        u[i] = (vertex >> k) & 1 ? upper[i] : lower[i];
      }
      most = std::max(most, gauge(q, linalg::product(pair.N, u) - pair.c));
    }
  } else {
    most = gauge(q, linalg::product(pair.N, middle) - pair.c);
    for (const Index i : entering) most += gauge(q, pair.N.col(i) * radius[i]);
  }
  // Σ ω_i |u_i - r_i| ≤ J lies in the hull of r ± J/ω_i e_i, a quadratic cost in that of r ± √(k
  // J/ω_i) e_i for k inputs.
  const bool bounded = std::isfinite(cost) && J.kind != Cost::Kind::norm_inf && !entering.empty();
  double by_cost = bounded ? 0 : infinity;
  Vector centre = middle;
  for (const Index i : entering) centre[i] = J.reference[i];
  for (const Index i : entering) {
    if (!bounded) break;
    const double share = cost / J.weights[i];
    const double far =
        J.kind == Cost::Kind::norm_1 ? share : std::sqrt(static_cast<double>(free) * share);
    if (!std::isfinite(far)) {
      by_cost = infinity;
      break;
    }
    for (const double sign : {-1.0, 1.0}) {
      Vector u = centre;
      u[i] += sign * far;
      by_cost = std::max(by_cost, gauge(q, linalg::product(pair.N, u) - pair.c));
    }
  }
  return std::min(most, by_cost) * (1 + margin) + margin - 1;
}

}  // namespace cordon::designers
