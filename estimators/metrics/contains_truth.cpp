// SPDX-License-Identifier: GPL-3.0-or-later
// Certified containment of the true state.
#include "metrics/average.hpp"

namespace cordon::estimators {

namespace {

using Shown = Measure::Shown;

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

}  // namespace

CORDON_COMPONENT(metric, contains_truth) {
  add_metric<ContainsTruth>(
      registrar, "contains_truth",
      "certified containment of the true state while the pipeline's assumptions hold");
}

}  // namespace cordon::estimators
