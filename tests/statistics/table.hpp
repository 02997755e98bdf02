// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cordon/study/result_table.hpp"

namespace tables {

/// Two pipelines, budgets 10 and 20, seeds 1 to 3; no columns and no rows.
inline cordon::ResultTable sweep() {
  cordon::ResultTable table;
  table.title = "Budgets";
  table.study_hash = "fnv1a64:0";
  table.version = "1.0";
  table.pipelines = {"first", "second"};
  table.axes = {{"budget", "/pipelines/*/observer/max_generators", {"10", "20"}, false},
                {"seed", "/data/simulate/seed", {"1", "2", "3"}, true}};
  return table;
}

}  // namespace tables
