// SPDX-License-Identifier: GPL-3.0-or-later
// Measured time of prediction, correction and reduction.
#include "metrics/average.hpp"

namespace cordon::estimators {

namespace {

using Shown = Measure::Shown;

class StepTime final : public Metric {
  std::vector<MetricValue> do_step(const StepView& view) override {
    const double time = view.times.step();
    average_.add(time);
    return {{"step_time_us", time}};
  }
  std::vector<MetricValue> do_summary() const override {
    return {{"step_time_us_mean", average_.mean()}, {"step_time_us_max", average_.largest()}};
  }
  std::vector<Measure> do_measures() const override {
    return {time_of("step_time_us_mean", "mean step time"),
            time_of("step_time_us_max", "largest step time")};
  }
  /// Tables hold the median of what the host has measured.
  static Measure time_of(const char* name, const char* title) {
    return {.name = name,
            .of = "step_time_us",
            .title = title,
            .unit = "µs",
            .better = Preference::less,
            .in_run = Shown::never,
            .in_comparison = Shown::never};
  }
  bool do_reproducible() const override { return false; }

  Average average_;
};

}  // namespace

CORDON_COMPONENT(metric, step_time) {
  add_metric<StepTime>(registrar, "step_time",
                       "measured time of prediction, correction and reduction in microseconds");
}

}  // namespace cordon::estimators
