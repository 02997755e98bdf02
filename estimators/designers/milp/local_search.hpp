// SPDX-License-Identifier: GPL-3.0-or-later
// Inputs that separate, found by following normals: where the mixed-integer program starts.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "designers/milp/gauge.hpp"
#include "designers/milp/program.hpp"

namespace cordon::designers {

class LocalSearch {
 public:
  /// `seconds_left` is asked before each linear program. The problem and the pairs outlive the
  /// search.
  LocalSearch(const SeparationProblem& problem, const std::vector<PairProgram>& pairs,
              std::function<double()> seconds_left);

  /// The normals of all pairs at u are kept, the cheapest input that they separate by κ ≥ ε is the
  /// next u, until it gets no cheaper. u itself need not be allowed. Nothing where the first
  /// normals leave no input.
  std::optional<Vector> from(Vector u);

  /// An upper bound of κ of pair q over inputs between `lower` and `upper` that cost at most `cost`
  /// (+inf: any). κ is convex: it is greatest at a vertex, of the box or of what the cost bounds;
  /// for many inputs, g(z₀ + Σ z_i) ≤ g(z₀) + Σ g(z_i).
  double largest_kappa(std::size_t q, const Vector& lower, const Vector& upper, double cost);

  std::int64_t programs() const { return programs_; }

 private:
  std::optional<Vector> cheapest(InputProgram program);
  double gauge(std::size_t q, const Vector& z);

  const SeparationProblem& problem_;
  const std::vector<PairProgram>& pairs_;
  std::function<double()> seconds_left_;
  InputProgram inputs_;
  std::vector<Gauge> gauges_;
  std::int64_t programs_ = 0;
};

}  // namespace cordon::designers
