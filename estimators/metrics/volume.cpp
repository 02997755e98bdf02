// SPDX-License-Identifier: GPL-3.0-or-later
// Volume of the set, or an upper bound of it.
#include "metrics/average.hpp"

namespace cordon::estimators {

namespace {

using Shown = Measure::Shown;

class VolumeOfSet final : public Metric {
  std::vector<MetricValue> do_step(const StepView& view) override {
    if (!is_set(view)) return {{"volume", not_available}, {"volume_of", std::string("none")}};
    const Volume volume = view.estimate.set->volume();
    average_.add(volume.value);
    if (!volume.exact) ++hulls_;
    return {{"volume", volume.value}, {"volume_of", std::string(volume.exact ? "set" : "hull")}};
  }
  std::vector<MetricValue> do_summary() const override {
    return {{"volume_mean", average_.mean()}, {"volume_of_hull_steps", hulls_}};
  }
  std::vector<Measure> do_measures() const override {
    return {{.name = "volume_mean",
             .of = "volume",
             .title = "mean volume",
             .quantity = Measure::Quantity::volume,
             .better = Preference::less,
             .ranked = true},
            {.name = "volume_of_hull_steps",
             .title = "volumes of hulls",
             .in_run = Shown::never,
             .in_comparison = Shown::never}};
  }

  Average average_;
  Index hulls_ = 0;
};

}  // namespace

CORDON_COMPONENT(metric, volume) {
  add_metric<VolumeOfSet>(
      registrar, "volume",
      "volume of the set where its representation has an exact one, else of its "
      "interval hull; takes "
      "long in three dimensions and more");
}

}  // namespace cordon::estimators
