// SPDX-License-Identifier: GPL-3.0-or-later
// The recursion's methods under the names of the reference.
#pragma once

#include <vector>

#include "observers/nonlinear/recursion.hpp"

namespace cordon::test {

using estimators::NonlinearOptions;
using formulas::AffineForm;

struct Method {
  const char* reference;
  const char* backend;
  NonlinearOptions options;
};

inline NonlinearOptions options(AffineForm form, bool contracts, bool carries_box,
                                bool row_by_row) {
  NonlinearOptions made;
  made.form = form;
  made.contracts = contracts;
  made.carries_box = carries_box;
  made.row_by_row = row_by_row;
  return made;
}

inline NonlinearOptions relaxation(bool contracts) {
  NonlinearOptions made = options(AffineForm::first_order, contracts, contracts, false);
  made.relaxes = true;
  return made;
}

inline NonlinearOptions boxes() {
  NonlinearOptions made;
  made.form = AffineForm::mean_value;
  made.boxes_only = true;
  return made;
}

inline NonlinearOptions natural() {
  NonlinearOptions made = boxes();
  made.natural_only = true;
  return made;
}

inline const std::vector<Method>& methods() {
  static const std::vector<Method> all = {
      {"interval_natural", "interval", natural()},
      {"interval", "interval", boxes()},
      {"zonotope_mean_value", "zonotope", options(AffineForm::mean_value, false, false, true)},
      {"zonotope_first_order_box", "zonotope", options(AffineForm::first_order, true, true, true)},
      {"cz_mean_value", "constrained_zonotope",
       options(AffineForm::mean_value, false, false, false)},
      {"cz_first_order", "constrained_zonotope",
       options(AffineForm::first_order, false, false, false)},
      {"cz_mean_value_hc4", "constrained_zonotope",
       options(AffineForm::mean_value, true, true, false)},
      {"cz_first_order_hc4", "constrained_zonotope",
       options(AffineForm::first_order, true, true, false)},
      {"cz_dc_scaled", "constrained_zonotope",
       options(AffineForm::convex_differences, false, false, false)},
      {"cz_relaxation", "constrained_zonotope", relaxation(false)},
      {"cz_relaxation_hc4", "constrained_zonotope", relaxation(true)},
  };
  return all;
}

}  // namespace cordon::test
