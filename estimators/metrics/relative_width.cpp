// SPDX-License-Identifier: GPL-3.0-or-later
// Widths of the interval hull as multiples of widths that are given, those of exact sets for
// example.
#include <cmath>
#include <map>

#include "metrics/average.hpp"

namespace cordon::estimators {

namespace {

constexpr double latest = 1e9;  // step

/// Times in steps: whole numbers, each later than the one before.
bool are_times(const Vector& steps) {
  for (Index i = 0; i < steps.size(); ++i) {
    const bool whole = steps[i] == std::floor(steps[i]) && steps[i] >= 0 && steps[i] <= latest;
    if (!whole || (i > 0 && steps[i] <= steps[i - 1])) return false;
  }
  return steps.size() > 0;
}

class RelativeWidth final : public Metric {
 public:
  explicit RelativeWidth(const Params& params) {
    const Vector& steps = params.vector("steps");
    const Matrix& widths = params.matrix("widths");
    for (Index i = 0; i < steps.size(); ++i)
      widths_.emplace(static_cast<Index>(steps[i]), widths.row(i).transpose());
  }

 private:
  std::vector<MetricValue> do_step(const StepView& view) override {
    const auto given = widths_.find(view.estimate.k);
    if (given == widths_.end() || !is_set(view)) return {{"relative_width", not_available}};
    const Vector ratios = (2 * view.hull.radius()).cwiseQuotient(given->second);
    average_.add(ratios.mean());
    return {{"relative_width", ratios.mean()}};
  }
  std::vector<MetricValue> do_summary() const override {
    return {{"relative_width_mean", average_.mean()},
            {"relative_width_max", average_.largest()},
            {"relative_width_unbounded_steps", average_.unbounded()}};
  }
  std::vector<Measure> do_measures() const override {
    return {{.name = "relative_width_mean",
             .of = "relative_width",
             .title = "mean relative width",
             .better = Preference::less,
             .ranked = true},
            {.name = "relative_width_max",
             .of = "relative_width",
             .title = "max relative width",
             .better = Preference::less,
             .in_comparison = Measure::Shown::never},
            {.name = "relative_width_unbounded_steps",
             .title = "unbounded steps",
             .better = Preference::less,
             .in_run = Measure::Shown::never,
             .in_comparison = Measure::Shown::if_any}};
  }

  std::map<Index, Vector> widths_;
  Average average_;
};

std::vector<Diagnostic> check_relative_width(const MetricContext& context, const Params& params) {
  std::vector<Diagnostic> problems;
  const Vector& steps = params.vector("steps");
  const Matrix& widths = params.matrix("widths");
  const Index n = context.model.states();
  if (!are_times(steps)) {
    problems.push_back({"/steps", "are no times in steps",
                        "give whole numbers from 0 on, each larger than the one before"});
  }
  if (widths.rows() != steps.size() || widths.cols() != n) {
    problems.push_back({"/widths",
                        "is " + std::to_string(widths.rows()) + " × " +
                            std::to_string(widths.cols()) + ", must be " +
                            std::to_string(steps.size()) + " × " + std::to_string(n),
                        "give a row per time and a column per state"});
  } else if (!(widths.array() > 0).all()) {
    problems.push_back({"/widths", "holds a number that is not larger than 0",
                        "leave times out at which a width is 0"});
  }
  return problems;
}

}  // namespace

CORDON_COMPONENT(metric, relative_width) {
  ParamSchema schema;
  schema.vector("steps", "the times k at which widths are given").required();
  schema
      .matrix("widths",
              "widths that count as 1, those of exact sets for example: a row per time and a "
              "column per state")
      .required();
  registrar.add(MetricEntry{
      {"relative_width",
       "widths of the interval hull as multiples of given ones, over all states and given times",
       "", std::move(schema)},
      [](const Params& params) -> std::unique_ptr<Metric> {
        return std::make_unique<RelativeWidth>(params);
      },
      check_relative_width});
}

}  // namespace cordon::estimators
