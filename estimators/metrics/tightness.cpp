// SPDX-License-Identifier: GPL-3.0-or-later
// Share of steps whose set is claimed to be exact.
#include "metrics/average.hpp"

namespace cordon::estimators {

namespace {

using Shown = Measure::Shown;

class ExactSteps final : public Metric {
  std::vector<MetricValue> do_step(const StepView& view) override {
    ++steps_;
    const bool exact = view.estimate.set.tightness == Tightness::exact;
    if (exact) ++exact_;
    return {{"exact", std::string(exact ? "yes" : "no")}};
  }
  std::vector<MetricValue> do_summary() const override {
    return {{"exact_share",
             steps_ ? static_cast<double>(exact_) / static_cast<double>(steps_) : not_available}};
  }
  std::vector<Measure> do_measures() const override {
    return {{.name = "exact_share",
             .title = "exact",
             .better = Preference::more,
             .share = true,
             .in_run = Shown::never,
             .in_comparison = Shown::never}};
  }

  Index steps_ = 0, exact_ = 0;
};

}  // namespace

CORDON_COMPONENT(metric, tightness) {
  add_metric<ExactSteps>(registrar, "tightness", "share of steps whose set is claimed to be exact");
}

}  // namespace cordon::estimators
