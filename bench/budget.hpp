// SPDX-License-Identifier: GPL-3.0-or-later
// What the work that users wait for may take: medians in microseconds on one core of the machine of
// docs/performance.md.
#pragma once

#include <optional>
#include <string>

namespace cordon::bench {

struct Budget {
  const char* benchmark;
  double microseconds;
};

inline constexpr Budget budgets[] = {
    {"step/LZ", 15},
    {"step_with_hull/LZ", 25},
    {"step/CZ", 18},
    {"step_with_hull/CZ", 28},
    {"step/Zonotope", 3},
    {"step/Interval", .5},
    {"interval_hull_certified/3/30/5", 10},
    {"interval_hull_certified/10/100/20", 600},
    {"interval_hull_certified/20/200/50", 15000},
    {"emptiness_of_non_empty/3/30/5", 3},
    {"emptiness_of_non_empty/10/100/20", 60},
    {"emptiness_of_non_empty/20/200/50", 500},
    {"emptiness_of_empty/3/30/5", 3},
    {"emptiness_of_empty/10/100/20", 60},
    {"emptiness_of_empty/20/200/50", 500},
    {"containment_of_inner_point/3/30/5", 5},
    {"containment_of_inner_point/10/100/20", 100},
    {"containment_of_inner_point/20/200/50", 900},
    {"containment_near_boundary/3/30/5", 5},
    {"containment_near_boundary/10/100/20", 150},
    {"containment_near_boundary/20/200/50", 1300},
    {"constraint_elimination_of_one/3/30/5", 3},
    {"constraint_elimination_of_one/10/100/20", 60},
    {"constraint_elimination_of_one/20/200/50", 650},
    {"constraint_elimination_to_5/3/30/5", 3},
    {"constraint_elimination_to_5/10/100/20", 250},
    {"constraint_elimination_to_5/20/200/50", 4000},
    {"generalised_intersection/3/30/5", 1},
    {"generalised_intersection/10/100/20", 10},
    {"generalised_intersection/20/200/50", 60},
    {"fixed_lag/three_states/40/10/5", 300},
    {"ellipsoid/trace/nominal", 8},
    {"ellipsoid/volume/nominal", 7},
    {"plugins_loaded_and_study_validated", 20000},
};

inline std::optional<double> budget_of(const std::string& benchmark) {
  for (const Budget& budget : budgets) {
    if (benchmark == budget.benchmark) return budget.microseconds;
  }
  return std::nullopt;
}

}  // namespace cordon::bench
