// SPDX-License-Identifier: GPL-3.0-or-later
#include "designers/exact_search.hpp"

#include <algorithm>
#include <limits>

#include "designers/cones/search.hpp"
#include "designers/facets/first_input.hpp"

namespace cordon::designers {

namespace {

constexpr double share_of_first = .05;       ///< of the time limit
constexpr double share_of_facets = .5;       ///< of what is left of it then
constexpr double share_of_reasons = .1;      ///< likewise, where it is known that there is no input
constexpr std::int64_t nodes_first = 10000;  ///< for sums of absolute inputs, none else

SearchResult without_input(SearchResult result) {
  result.status = DesignStatus::infeasible;
  result.u.reset();
  result.stopped = false;
  result.reason = "no input of the input set separates all pairs of modes";
  result.suggestion = "a larger input set, a longer horizon, or a smaller epsilon";
  return result;
}

SearchResult concluded(const KnownAnswer& known, double gap, SearchResult result) {
  result.u = known.u;
  result.cost = known.u ? known.cost : 0;
  result.lower_bound = std::min(known.bound, known.cost);
  if (known.is_closed(gap)) {
    result.status = DesignStatus::optimal;
    result.stopped = false;
    result.reason = result.suggestion = {};
  } else {
    result.status = known.u ? DesignStatus::feasible : DesignStatus::unknown;
  }
  return result;
}

}  // namespace

SearchResult search_exactly(const SeparationProblem& problem, const FacetLimits& limits,
                            DesignControl& control) {
  Watch watch(control, problem.horizon, limits.time_limit);
  NodeProgram inputs(problem);
  const Watch early(control, problem.horizon, share_of_first * limits.time_limit);
  KnownAnswer known = first_input(problem, inputs, [&] { return early.over(); });
  ConeSearch cones(problem, inputs, known, limits.gap, watch);
  const bool of_sums = problem.cost.kind == Cost::Kind::norm_1;
  cones.run(of_sums ? nodes_first : 0);

  SearchResult result;
  if (!known.is_closed(limits.gap)) {
    FacetLimits here = limits;
    here.time_limit = watch.left();
    if (cones.impossible()) here.time_limit *= share_of_reasons;
    if (!cones.ended()) here.time_limit *= share_of_facets;
    result = search_facets(problem, here, known, control);
    if (result.u) known.offer(*result.u, result.cost);
    known.raise(result.lower_bound);
    if (result.status != DesignStatus::infeasible && !known.is_closed(limits.gap))
      cones.run(std::numeric_limits<std::int64_t>::max());
    result.stopped = result.stopped || watch.over();
  }
  result.nodes += cones.nodes();
  result.programs += cones.programs() + inputs.programs();
  if (result.status == DesignStatus::infeasible) return result;
  if (cones.impossible()) return without_input(std::move(result));
  return concluded(known, limits.gap, std::move(result));
}

}  // namespace cordon::designers
