// SPDX-License-Identifier: GPL-3.0-or-later
// Half the longest edge of the interval hull.
#include "metrics/average.hpp"

namespace cordon::estimators {

namespace {

using Shown = Measure::Shown;

class Radius final : public Metric {
 public:
  explicit Radius(const Params& params) {
    if (params.has("scales")) scales_ = params.vector("scales");
  }

 private:
  std::vector<MetricValue> do_step(const StepView& view) override {
    if (!is_set(view)) return {{"radius", not_available}};
    const double radius = scales_.size() > 0 ? view.hull.radius().cwiseQuotient(scales_).maxCoeff()
                                             : view.hull.longest_half_edge();
    average_.add(radius);
    return {{"radius", radius}};
  }
  std::vector<MetricValue> do_summary() const override {
    return {{"radius_mean", average_.mean()},
            {"radius_max", average_.largest()},
            {"radius_unbounded_steps", average_.unbounded()}};
  }
  std::vector<Measure> do_measures() const override {
    const auto quantity =
        scales_.size() == 0 ? Measure::Quantity::length : Measure::Quantity::number;
    return {{.name = "radius_mean",
             .of = "radius",
             .title = "mean radius",
             .quantity = quantity,
             .better = Preference::less,
             .ranked = true},
            {.name = "radius_max",
             .of = "radius",
             .title = "max radius",
             .quantity = quantity,
             .better = Preference::less,
             .in_comparison = Shown::never},
            {.name = "radius_unbounded_steps",
             .title = "unbounded steps",
             .better = Preference::less,
             .in_run = Shown::never,
             .in_comparison = Shown::if_any}};
  }

  Vector scales_;  ///< dimension 0: none
  Average average_;
};

std::vector<Diagnostic> check_radius(const MetricContext& context, const Params& params) {
  if (!params.has("scales")) return {};
  const Vector& scales = params.vector("scales");
  const Index n = context.model.states();
  if (scales.size() != n) {
    return {
        {"/scales",
         "has " + std::to_string(scales.size()) + " numbers, the state has " + std::to_string(n),
         "give one per state"}};
  }
  if ((scales.array() > 0).all()) return {};
  return {{"/scales", "holds a number that is not larger than 0",
           "give the size that counts as 1, for every state"}};
}

}  // namespace

CORDON_COMPONENT(metric, radius) {
  ParamSchema of_radius;
  of_radius.vector("scales",
                   "each half edge is divided by the number of its state: what counts as 1, in the "
                   "state's unit");
  registrar.add(MetricEntry{
      {"radius", "half the longest edge of the interval hull", "", std::move(of_radius)},
      [](const Params& params) -> std::unique_ptr<Metric> {
        return std::make_unique<Radius>(params);
      },
      check_radius});
}

}  // namespace cordon::estimators
