// SPDX-License-Identifier: GPL-3.0-or-later
// Reports of `cordon design` and of runs with designed inputs, and their exit codes.
#include "design_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "design_outcome_text.hpp"
#include "diagnosis_report.hpp"
#include "json_text.hpp"

namespace cordon::apps {

namespace {

using Rows = std::vector<std::vector<std::string>>;
using nlohmann::ordered_json;

std::string design_text(const Study& study, const PipelineDesign& design, const Paint& paint) {
  const Names modes = mode_names(study);
  std::string text =
      fmt::format("{}  {}, {}\n", paint.bold(design.name), design.backend, design.designer);
  if (design.outcome) {
    const DesignOutcome& outcome = *design.outcome;
    const ExactSeparation* exact = design.exact ? &*design.exact : nullptr;
    text += status_text(outcome, design.designer, exact, paint) + "\n" + restriction_text(outcome) +
            horizon_text(outcome) + reason_text(outcome, exact);
    if (outcome.best) text += input_text(study.labels, modes, *outcome.best, exact, paint);
    text += refuted_text(design.refuted, paint) + search_text(outcome, design.design_s);
  }
  if (!design.error.empty()) text += paint.red(fmt::format("Stopped: {}", design.error)) + "\n";
  return text;
}

/// Which modes were possible at the ends of the experiments with each, and what was decided.
std::string experiments_text(const Names& modes, const std::vector<ExperimentRow>& experiments,
                             const Paint& paint) {
  Rows rows{{"TRUE MODE", "RUNS"}};
  for (const std::string& mode : modes) rows[0].push_back(mode);
  rows[0].insert(rows[0].end(), {"ISOLATED", "WRONG", "NONE", "UNDECIDED", "ISOLATED AT k"});
  for (const ExperimentRow& row : experiments) {
    rows.push_back({modes[static_cast<std::size_t>(row.mode)], fmt::format("{}", row.runs)});
    for (const std::int64_t count : row.possible) rows.back().push_back(fmt::format("{}", count));
    for (const std::int64_t count : {row.isolated, row.wrong, row.unknown_fault, row.undecided}) {
      rows.back().push_back(fmt::format("{}", count));
    }
    rows.back().push_back(row.isolation.count > 0 ? fmt::format("{}", row.isolation.median) : "-");
  }
  return fmt::format(
      "Experiments with every mode: at their ends, how often each mode is possible (k: the "
      "median)\n{}",
      table(rows, paint));
}

/// Why experiments may have stayed open: samples of the input's end that decide nothing.
std::string unused_samples_text(const DesignedOutcome& found) {
  const bool undecided = std::any_of(found.experiments.begin(), found.experiments.end(),
                                     [](const ExperimentRow& row) { return row.undecided > 0; });
  if (!undecided || !found.last_used_sample) return "";
  const Index last = *found.last_used_sample, needed = found.design->horizon;
  if (last >= needed) return "";
  return fmt::format(
      "Undecided: the diagnoser takes no sample after k = {}, the input goes on to k = {}. To try: "
      "a \"horizon\" of {}\n",
      last, needed, needed);
}

/// Does the exact proof leave a question open?
bool open(const PipelineDesign& design) {
  if (!design.exact) return false;
  const auto unknown = [](const auto& answer) { return answer == Answer::unknown; };
  return std::any_of(design.exact->empty.begin(), design.exact->empty.end(), unknown) ||
         std::any_of(design.exact->pairs.begin(), design.exact->pairs.end(),
                     [&](const auto& p) { return unknown(p.disjoint); });
}

}  // namespace

std::string designs_text(const Study& study, const std::vector<PipelineDesign>& designs,
                         const Paint& paint) {
  std::string text = study.title.empty() ? "" : paint.bold(study.title) + "\n";
  for (const PipelineDesign& design : designs) {
    if (!text.empty()) text += '\n';
    text += design_text(study, design, paint);
  }
  return text;
}

ordered_json exact_json(const std::optional<ExactSeparation>& exact, const Names& modes) {
  if (!exact) return nullptr;
  ordered_json json = ordered_json::parse(json_of(*exact, modes));
  json["wall_s"] = exact->wall_s;
  return json;
}

std::string designs_json(const Study& study, const std::vector<PipelineDesign>& designs) {
  const Names modes = mode_names(study);
  ordered_json report{{"modes", modes}, {"pipelines", ordered_json::array()}};
  for (const PipelineDesign& design : designs) {
    report["pipelines"].push_back(
        {{"name", design.name},
         {"backend", design.backend},
         {"designer", design.designer},
         {"design", design.outcome ? ordered_json::parse(json_of(*design.outcome, modes))
                                   : ordered_json(nullptr)},
         {"exact", exact_json(design.exact, modes)},
         {"refuted", design.refuted},
         {"design_s", design.design_s},
         {"error", design.error.empty() ? ordered_json(nullptr) : ordered_json(design.error)}});
  }
  return json_text(report);
}

std::vector<std::string> refutations(const std::string& pipeline,
                                     const std::vector<std::string>& refuted) {
  Names found;
  for (const std::string& claim : refuted) {
    found.push_back(fmt::format(
        "pipeline \"{}\" violates its guarantee: {}. This is a defect of its designer or backend",
        pipeline, claim));
  }
  return found;
}

std::vector<std::string> complaints(const Study& study, const std::vector<PipelineDesign>& designs,
                                    bool all_proven) {
  const Names modes = mode_names(study);
  std::vector<std::string> found;
  for (const PipelineDesign& design : designs) {
    const std::string name = fmt::format("pipeline \"{}\"", design.name);
    if (!design.error.empty()) found.push_back(fmt::format("{} stopped: {}", name, design.error));
    for (std::string& claim : refutations(design.name, design.refuted))
      found.push_back(std::move(claim));
    if (!design.outcome) continue;
    if (design.outcome->status == DesignStatus::unknown) {
      found.push_back(name + (design.outcome->stopped ? ": no input was found within the limit"
                                                      : ": no input was found"));
    } else if (all_proven && open(design)) {
      found.push_back(name + ": the exact proof leaves a question open");
    }
    if (!design.outcome->best) continue;
    const Names empty =
        empty_modes(modes, design.outcome->best->empty, design.exact ? &*design.exact : nullptr);
    if (!empty.empty()) found.push_back(fmt::format("{}: {}", name, empty_text(empty)));
  }
  return found;
}

Exit exit_of(const std::vector<PipelineDesign>& designs, bool all_proven) {
  Exit exit = Exit::done;
  const auto worst = [&](Exit other) {
    exit = exit == Exit::done || exit == Exit::unanswered ? other : exit;
  };
  for (const PipelineDesign& design : designs) {
    if (!design.refuted.empty() || design.error_code == Errc::violated) return Exit::violated;
    if (!design.error.empty()) worst(exit_for(design.error_code.value_or(Errc::internal)));
    if (design.outcome && design.outcome->best) {
      const std::vector<Answer>& claimed = design.outcome->best->empty;
      const bool empty =
          !empty_modes(Names(claimed.size()), claimed, design.exact ? &*design.exact : nullptr)
               .empty();
      if (empty) worst(Exit::invalid);
    }
    const bool unknown = design.outcome && design.outcome->status == DesignStatus::unknown;
    if ((unknown || (all_proven && open(design))) && exit == Exit::done) exit = Exit::unanswered;
  }
  return exit;
}

std::vector<std::string> empty_tubes(const Study& study, const PipelineOutcome& pipeline) {
  const DesignedOutcome& found = *pipeline.design();
  if (!found.design || !found.design->best) return {};
  return empty_modes(mode_names(study), found.design->best->empty,
                     found.exact ? &*found.exact : nullptr);
}

std::string design_text(const Study& study, const PipelineOutcome& pipeline, const Paint& paint) {
  const Names modes = mode_names(study);
  const DesignedOutcome& found = *pipeline.design();
  const std::string diagnoser = found.diagnoser.empty() ? "" : fmt::format(", {}", found.diagnoser);
  std::string text = fmt::format("{}  {}, {}{}\n", paint.bold(pipeline.name), pipeline.backend,
                                 found.designer, diagnoser);
  if (found.design) {
    const DesignOutcome& outcome = *found.design;
    const ExactSeparation* exact = found.exact ? &*found.exact : nullptr;
    text += status_text(outcome, found.designer, exact, paint) + "\n" + restriction_text(outcome) +
            horizon_text(outcome) + reason_text(outcome, exact);
    if (outcome.best) {
      text += input_text(study.labels, modes, *outcome.best, exact, paint);
      if (found.diagnoser.empty())
        text +=
            "\nNo experiments: name a \"diagnoser\" beside the designer to try the input on every "
            "mode\n";
    } else {
      text += "No experiments: there is no input to try\n";
    }
  }
  if (!found.experiments.empty())
    text += fmt::format("\n{}", experiments_text(modes, found.experiments, paint));
  text += refuted_text(found.refuted, paint) + unused_samples_text(found) +
          assumption_text(study, pipeline, paint);
  if (!pipeline.error.empty()) text += paint.red(fmt::format("Stopped: {}", pipeline.error)) + "\n";
  return text;
}

std::string design_progress(const std::string& name, Index horizon, double best, double bound) {
  std::string text = fmt::format("{:.20}  N = {}", name, horizon);
  if (std::isfinite(best)) text += fmt::format("  best {:.6g}", best);
  if (std::isfinite(bound)) text += fmt::format("  at least {:.6g}", bound);
  if (std::isfinite(best) && std::isfinite(bound) && best > 0)
    text += fmt::format("  ({:.2g} %)", 100 * std::max(0.0, best - bound) / best);
  return text;
}

}  // namespace cordon::apps
