// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of merit of an estimate:
//   radius          half the longest edge of the interval hull
//   volume          of the set, or an upper bound of it
//   contains_truth  certified containment of the true state
//   complexity      generators, lines and constraints
//   tightness       share of steps whose set is claimed to be exact
//   step_time       measured time of prediction, correction and reduction
#include <algorithm>
#include <cmath>
#include <limits>

#include "components.hpp"

namespace cordon::estimators {

namespace {

using Shown = Measure::Shown;

/// Mean over the finite values and the largest of them; how many were unbounded.
class Average {
 public:
  void add(double value) {
    if (!std::isfinite(value)) {
      ++unbounded_;
      return;
    }
    ++count_;
    sum_ += value;
    largest_ = count_ == 1 ? value : std::max(largest_, value);
  }
  double mean() const { return count_ ? sum_ / static_cast<double>(count_) : not_available; }
  double largest() const { return count_ ? largest_ : not_available; }
  Index unbounded() const { return unbounded_; }

 private:
  Index count_ = 0, unbounded_ = 0;
  double sum_ = 0, largest_ = 0;
};

/// Estimates proven empty have no size.
bool is_set(const StepView& view) { return view.estimate.consistent != Answer::no; }

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
    const bool mixes = scales_.size() == 0;
    return {{.name = "radius_mean",
             .title = "mean radius",
             .better = Preference::less,
             .ranked = true,
             .mixes_states = mixes},
            {.name = "radius_max",
             .title = "max radius",
             .better = Preference::less,
             .in_comparison = Shown::never,
             .mixes_states = mixes},
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
    return {
        {.name = "volume_mean", .title = "mean volume", .better = Preference::less, .ranked = true},
        {.name = "volume_of_hull_steps",
         .title = "volumes of hulls",
         .in_run = Shown::never,
         .in_comparison = Shown::never}};
  }

  Average average_;
  Index hulls_ = 0;
};

class ContainsTruth final : public Metric {
  std::vector<MetricValue> do_step(const StepView& view) override {
    if (!view.truth || !view.assumptions_hold)
      return {{"contains_truth", std::string("not_applicable")}};
    const Answer answer = view.estimate.set->contains(*view.truth);
    ++(answer == Answer::yes ? yes_ : answer == Answer::no ? no_ : unknown_);
    return {{"contains_truth", std::string(to_string(answer))}};
  }
  std::vector<MetricValue> do_summary() const override {
    const Index asked = yes_ + no_ + unknown_;
    return {{"contains_truth_yes", yes_},
            {"contains_truth_no", no_},
            {"contains_truth_unknown", unknown_},
            {"contains_truth_share",
             asked ? static_cast<double>(yes_) / static_cast<double>(asked) : not_available}};
  }
  std::vector<Measure> do_measures() const override {
    return {{.name = "contains_truth_yes",
             .title = "truth inside",
             .better = Preference::more,
             .rest = {"contains_truth_no", "contains_truth_unknown"},
             .in_comparison = Shown::never},
            {.name = "contains_truth_no",
             .title = "truth outside",
             .better = Preference::less,
             .in_run = Shown::if_any,
             .in_comparison = Shown::if_any},
            {.name = "contains_truth_unknown",
             .title = "truth undecided",
             .better = Preference::less,
             .in_run = Shown::if_any,
             .in_comparison = Shown::if_any},
            {.name = "contains_truth_share",
             .title = "truth inside",
             .better = Preference::more,
             .share = true,
             .in_run = Shown::never}};
  }

  Index yes_ = 0, no_ = 0, unknown_ = 0;
};

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
            .title = title,
            .unit = "µs",
            .better = Preference::less,
            .in_run = Shown::never,
            .in_comparison = Shown::never};
  }
  bool do_reproducible() const override { return false; }

  Average average_;
};

template <class M>
void add(Registrar& registrar, const char* name, const char* summary) {
  registrar.add(MetricEntry{{name, summary, "", {}}, [](const Params&) -> std::unique_ptr<Metric> {
                              return std::make_unique<M>();
                            }});
}

}  // namespace

void register_metrics(Registrar& registrar) {
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
  add<VolumeOfSet>(registrar, "volume",
                   "volume of the set where its representation has an exact one, else of its "
                   "interval hull; takes "
                   "long in three dimensions and more");
  add<ContainsTruth>(
      registrar, "contains_truth",
      "certified containment of the true state while the pipeline's assumptions hold");
  add<Size>(registrar, "complexity", "generators, lines and constraints of the estimate");
  add<ExactSteps>(registrar, "tightness", "share of steps whose set is claimed to be exact");
  add<StepTime>(registrar, "step_time",
                "measured time of prediction, correction and reduction in microseconds");
}

}  // namespace cordon::estimators
