// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_failures.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "design_report.hpp"
#include "diagnosis_report.hpp"

namespace cordon::apps {

namespace {

/// A guarantee that was violated at `violated_at`.
std::string violation(const Labels& labels, const PipelineOutcome& pipeline) {
  if (pipeline.diagnosis()) return diagnosis_violation(labels, pipeline);
  if (pipeline.design()) {
    return fmt::format(
        "pipeline \"{}\" violates its guarantee: at {} of an experiment its diagnoser excludes "
        "the true mode. This is a defect of its backend or diagnoser",
        pipeline.name, time_text(labels, pipeline.violated_at));
  }
  return fmt::format(
      "pipeline \"{}\" violates its guarantee: at {} the true state is {} outside the "
      "estimate. This is a defect of its backend or observer",
      pipeline.name, time_text(labels, pipeline.violated_at),
      pipeline.estimation()->outside_proven ? "proven" : "said to be");
}

void add_complaints(const Study& study, const PipelineOutcome& pipeline,
                    const DesignedOutcome& found, std::vector<std::string>& complaints) {
  if (!found.design) return;
  for (std::string& claim : refutations(pipeline.name, found.refuted))
    complaints.push_back(std::move(claim));
  for (const std::string& mode : empty_tubes(study, pipeline)) {
    complaints.push_back(fmt::format(
        "pipeline \"{}\": no output of mode \"{}\" fits its input: the model contradicts itself",
        pipeline.name, mode));
  }
  if (found.design->status == DesignStatus::unknown) {
    complaints.push_back(fmt::format("pipeline \"{}\": no input was found{}", pipeline.name,
                                     found.design->stopped ? " within the limit" : ""));
  }
}

bool has_empty_tube(const DesignedOutcome& found) {
  const auto any = [](const std::vector<Answer>& empty) {
    return std::find(empty.begin(), empty.end(), Answer::yes) != empty.end();
  };
  return (found.design->best && any(found.design->best->empty)) ||
         (found.exact && any(found.exact->empty));
}

/// Something that must hold is proven not to.
bool is_violated(const PipelineOutcome& pipeline) {
  const EstimationOutcome* const estimated = pipeline.estimation();
  const DesignedOutcome* const designed = pipeline.design();
  return pipeline.violated_at >= 0 || pipeline.error_code == Errc::violated ||
         (estimated && estimated->inner_outside >= 0) || (designed && !designed->refuted.empty());
}

}  // namespace

std::vector<std::string> complaints(const Study& study, const RunOutcome& outcome) {
  std::vector<std::string> found;
  for (const PipelineOutcome& pipeline : outcome.pipelines) {
    if (!pipeline.error.empty()) {
      found.push_back(fmt::format("pipeline \"{}\" stopped after {} steps: {}", pipeline.name,
                                  pipeline.steps, pipeline.error));
    }
    if (const DesignedOutcome* const designed = pipeline.design())
      add_complaints(study, pipeline, *designed, found);
    if (pipeline.violated_at >= 0) found.push_back(violation(study.labels, pipeline));
    const EstimationOutcome* const estimated = pipeline.estimation();
    if (estimated && estimated->inner_outside >= 0) {
      found.push_back(fmt::format(
          "pipeline \"{}\" violates its guarantee: at {} its inner estimate, of trajectories "
          "that it must enclose, "
          "leaves the hull of its estimate. This is a defect of its backend or observer",
          pipeline.name, time_text(study.labels, estimated->inner_outside)));
    }
  }
  return found;
}

Exit exit_of(const RunOutcome& outcome) {
  Exit exit = Exit::done;
  for (const PipelineOutcome& pipeline : outcome.pipelines) {
    if (is_violated(pipeline)) return Exit::violated;
    const bool answered = exit != Exit::done && exit != Exit::unanswered;
    if (!answered && !pipeline.error.empty())
      exit = exit_for(pipeline.error_code.value_or(Errc::internal));
    const DesignedOutcome* const found = pipeline.design();
    if (!found || !found->design || answered) continue;
    if (has_empty_tube(*found)) exit = Exit::invalid;
    if (found->design->status == DesignStatus::unknown && exit == Exit::done)
      exit = Exit::unanswered;
  }
  return exit;
}

}  // namespace cordon::apps
