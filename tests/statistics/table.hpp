// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/study/result_table.hpp"

namespace tables {

/// What metrics may tell of their numbers.
inline std::vector<cordon::Measure> told() {
  using cordon::Preference;
  return {
      {.name = "radius_mean", .title = "mean radius", .better = Preference::less, .ranked = true},
      {.name = "radius_max",
       .better = Preference::less,
       .in_comparison = cordon::Measure::Shown::never},
      {.name = "contains_truth_share",
       .title = "truth inside",
       .better = Preference::more,
       .share = true},
      {.name = "generators_max", .title = "used generators"}};
}

/// Two pipelines, budgets 10 and 20, seeds 1 to 3; no columns and no rows.
inline cordon::ResultTable sweep() {
  cordon::ResultTable table;
  table.title = "Budgets";
  table.study_hash = "fnv1a64:0";
  table.version = "1.0";
  table.pipelines = {"first", "second"};
  table.axes = {{"budget", "/pipelines/*/observer/max_generators", {"10", "20"}, false},
                {"seed", "/data/simulate/seed", {"1", "2", "3"}, true}};
  table.measures = told();
  return table;
}

}  // namespace tables
