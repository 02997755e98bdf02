// SPDX-License-Identifier: GPL-3.0-or-later
// A metric as a plugin: the sum of the widths of the estimate's hull. Start from here and replace
// the number by your own.
#include <cordon/registry/plugin.hpp>

namespace {

using namespace cordon;

class MyMetric final : public Metric {
 private:
  std::vector<MetricValue> do_step(const StepView& view) override {
    const Box& hull = view.hull;
    const double widths = hull.is_empty() ? 0.0 : (hull.upper - hull.lower).sum();
    total_ += widths;
    ++steps_;
    return {{"widths", widths}};
  }
  /// NaN stands for "not available".
  std::vector<MetricValue> do_summary() const override {
    return {{"mean_widths", steps_ > 0 ? total_ / static_cast<double>(steps_) : not_available}};
  }
  /// What tables and reports are told of it.
  std::vector<Measure> do_measures() const override {
    Measure mean;
    mean.name = "mean_widths";
    mean.of = "widths";
    mean.title = "mean sum of widths";
    mean.quantity = Measure::Quantity::length;
    mean.better = Preference::less;
    mean.ranked = true;
    return {mean};
  }

  double total_ = 0;
  Index steps_ = 0;
};

void register_components(Registrar& registrar) {
  registrar.add(MetricEntry{
      {"my_metric", "sum of the widths of the hull", "", {}},
      [](const Params&) -> std::unique_ptr<Metric> { return std::make_unique<MyMetric>(); }});
}

}  // namespace

CORDON_PLUGIN("my_metric", "0.1.0", "GPL-3.0-or-later", "A. Uthor", "a metric of my own",
              register_components)
