// SPDX-License-Identifier: GPL-3.0-or-later
// Generators, lines and constraints.
#include "metrics/average.hpp"

namespace cordon::estimators {

namespace {

using Shown = Measure::Shown;

class Size final : public Metric {
  std::vector<MetricValue> do_step(const StepView& view) override {
    const Complexity c = view.estimate.set->complexity();
    largest_ = {std::max(largest_.generators, c.generators), std::max(largest_.lines, c.lines),
                std::max(largest_.constraints, c.constraints)};
    return {{"generators", c.generators}, {"lines", c.lines}, {"constraints", c.constraints}};
  }
  std::vector<MetricValue> do_summary() const override {
    return {{"generators_max", largest_.generators},
            {"lines_max", largest_.lines},
            {"constraints_max", largest_.constraints}};
  }
  std::vector<Measure> do_measures() const override {
    return {{.name = "generators_max", .title = "used generators", .short_title = "gen"},
            {.name = "lines_max",
             .title = "used lines",
             .short_title = "lines",
             .in_comparison = Shown::never},
            {.name = "constraints_max", .title = "used constraints", .short_title = "constr"}};
  }

  Complexity largest_;
};

}  // namespace

CORDON_COMPONENT(metric, complexity) {
  add_metric<Size>(registrar, "complexity", "generators, lines and constraints of the estimate");
}

}  // namespace cordon::estimators
