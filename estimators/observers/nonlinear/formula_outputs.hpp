// SPDX-License-Identifier: GPL-3.0-or-later
// The range of an output by formulas over a box of states: what Observer::output_bounds asks for.
#pragma once

#include <utility>
#include <vector>

#include "cordon/interfaces/nonlinear_model.hpp"
#include "cordon/interfaces/observer.hpp"

namespace cordon::estimators {

class FormulaOutputs {
 public:
  FormulaOutputs(const Model& model, const SetBackend& backend)
      : g_(model.nonlinear->g, backend.info().rounding, model.nonlinear->undefined),
        V_(backend.import(model.V)->interval_hull()) {}

  /// Bounds of the output, and of what its value in doubles is off by.
  std::pair<Interval, double> bounds(const Box& states, Index output, const Sample& now) {
    std::vector<Interval> variables;
    for (const Box* box : {&states, static_cast<const Box*>(&V_)}) {
      for (Index i = 0; i < box->dim(); ++i) variables.push_back({box->lower[i], box->upper[i]});
    }
    for (const double known : now.u) variables.push_back({known, known});
    const auto time = static_cast<double>(now.k);
    variables.push_back({time, time});
    g_.evaluate(variables);
    const Interval range = g_.value(output);
    g_.bound_rounding();
    return {range, g_.rounding_error(output)};
  }

 private:
  formulas::Evaluator g_;  ///< g, and h
  Box V_;
};

}  // namespace cordon::estimators
