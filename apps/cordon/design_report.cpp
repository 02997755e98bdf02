// SPDX-License-Identifier: GPL-3.0-or-later
#include "design_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "diagnosis_report.hpp"

namespace cordon::apps {

namespace {

using Names = std::vector<std::string>;
using Rows = std::vector<std::vector<std::string>>;
using nlohmann::ordered_json;

Names mode_names(const Study& study) {
  Names names;
  for (const Mode& mode : bank_of(study).modes) names.push_back(mode.name);
  return names;
}

std::string number(double value) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return value > 0 ? "∞" : "-∞";
  return fmt::format("{:.6g}", value);
}

std::string pair_name(const Names& modes, Index i, Index j) {
  return modes[static_cast<std::size_t>(i)] + ", " + modes[static_cast<std::size_t>(j)];
}

/// What of it is proven, else what the designer claims. Without colours: cells of a table are
/// aligned by their length.
std::string separation(Answer claimed, const ExactPair* exact) {
  const bool proven = exact && exact->disjoint != Answer::unknown;
  const Answer disjoint = proven ? exact->disjoint : claimed;
  if (disjoint == Answer::unknown) return "not decided";
  return fmt::format("{} ({})", disjoint == Answer::yes ? "disjoint" : "meet",
                     proven ? "proven" : "claimed");
}

/// What is said of the cost of every separating input.
std::string bound_text(const DesignOutcome& outcome) {
  if (std::isinf(outcome.lower_bound)) return "no lower bound is known";
  return fmt::format("claimed lower bound {}", number(outcome.lower_bound));
}

/// What was searched in place of the problem.
std::string restriction_text(const DesignOutcome& outcome) {
  if (!outcome.restriction) return "";
  const double bound = outcome.restriction->lower_bound;
  const std::string known =
      std::isfinite(bound)
          ? fmt::format("; that one costs at least {}, the problem itself may cost less",
                        number(bound))
          : "";
  return fmt::format("Searched in place of the problem: {}{}\n", outcome.restriction->name, known);
}

/// The separation that is proven, or else the one that is claimed: green, red or yellow.
std::string separated_text(const InputDesign& best, const ExactSeparation* exact,
                           const Paint& paint) {
  const Answer proven = exact ? exact->separates() : Answer::unknown;
  if (proven == Answer::yes) return paint.green("separated (proven)");
  if (proven == Answer::no) return paint.red("not separated (proven)");
  return paint.yellow(best.separates() == Answer::yes  ? "separated (claimed)"
                      : best.separates() == Answer::no ? "not separated (claimed)"
                                                       : "not proven to be separated");
}

std::string status_text(const DesignOutcome& outcome, const std::string& designer,
                        const ExactSeparation* exact, const Paint& paint) {
  const std::string cost = fmt::format("cost {}", number(outcome.best ? outcome.best->cost : 0));
  switch (outcome.status) {
    case DesignStatus::optimal:
      return paint.green("Optimal") +
             fmt::format(" (claimed by {}): {}, {}", designer, cost, bound_text(outcome));
    case DesignStatus::feasible: {
      const std::string gap = std::isfinite(outcome.gap())
                                  ? fmt::format(" with claimed gap {:.3g} %", 100 * outcome.gap())
                                  : "";
      return paint.yellow(fmt::format("Feasible{}", gap)) +
             fmt::format(": {}, {}", cost, bound_text(outcome));
    }
    case DesignStatus::infeasible:
      return paint.yellow("Infeasible") +
             fmt::format(" (claimed by {}): no input of the input set separates the modes",
                         designer);
    case DesignStatus::unknown:
      return paint.yellow(outcome.stopped ? "No answer within the limit" : "No answer") + ": " +
             bound_text(outcome);
    case DesignStatus::given:
      break;
  }
  return fmt::format("Given: {}, the modes are {}", cost,
                     separated_text(*outcome.best, exact, paint));
}

std::string inputs_table(const Matrix& u, const Paint& paint) {
  Rows rows{{"k"}};
  for (Index i = 1; i <= u.cols(); ++i) rows[0].push_back(fmt::format("u_{}", i));
  for (Index k = 0; k < u.rows(); ++k) {
    rows.push_back({fmt::format("{}", k)});
    for (Index i = 0; i < u.cols(); ++i) rows.back().push_back(fmt::format("{:.8g}", u(k, i)));
  }
  return table(rows, paint);
}

/// The designer's κ, as computed, as far as it agrees with what is proven.
double shown_kappa(double kappa, const ExactPair* proven) {
  if (proven && proven->disjoint == Answer::yes) return std::max(kappa, proven->kappa_lower);
  if (proven && proven->disjoint == Answer::no) return std::min(kappa, 0.0);
  return kappa;
}

std::string pairs_table(const Names& modes, const InputDesign& design, const ExactSeparation* exact,
                        const Paint& paint) {
  Rows rows{{"PAIR", "κ", "AT LEAST", "OUTPUT TUBES"}};
  for (std::size_t q = 0; q < design.pairs.size(); ++q) {
    const PairSeparation& pair = design.pairs[q];
    const ExactPair* proven = exact ? &exact->pairs[q] : nullptr;
    const bool apart = proven && proven->disjoint == Answer::yes;
    rows.push_back({pair_name(modes, pair.i, pair.j), number(shown_kappa(pair.kappa, proven)),
                    apart ? number(proven->kappa_lower) : "-", separation(pair.disjoint, proven)});
  }
  return table(rows, paint);
}

/// Modes whose tube is empty, as the designer says or by the exact proof.
Names empty_modes(const Names& modes, const std::vector<Answer>& empty,
                  const ExactSeparation* exact) {
  Names found;
  for (std::size_t i = 0; i < empty.size(); ++i) {
    if (empty[i] == Answer::yes || (exact && exact->empty[i] == Answer::yes))
      found.push_back(modes[i]);
  }
  return found;
}

std::string empty_text(const Names& empty) {
  return fmt::format(
      "no output of {} fits this input: the model contradicts itself, and being apart from it says "
      "nothing. Check the admissible "
      "set, X0 and the static rows",
      fmt::join(empty, ", "));
}

std::string horizon_text(const DesignOutcome& outcome) {
  std::string text =
      fmt::format("Horizon N = {}: {} of k = 0 … {}\n", outcome.horizon,
                  outcome.last_output_only ? "inputs, and the last output," : "inputs and outputs",
                  outcome.horizon);
  for (const HorizonTrial& trial : outcome.tried) {
    text += fmt::format("  tried before: N = {}, {}{}{}\n", trial.horizon, to_string(trial.status),
                        trial.reason.empty() ? "" : ": ", trial.reason);
  }
  return text;
}

std::string reason_text(const DesignOutcome& outcome) {
  std::string text = outcome.reason.empty() ? "" : fmt::format("{}\n", outcome.reason);
  if (!outcome.suggestion.empty()) text += fmt::format("To try: {}\n", outcome.suggestion);
  return text;
}

std::string search_text(const DesignOutcome& outcome, double design_s) {
  if (outcome.programs == 0) return fmt::format("Time: {:.3g} s\n", design_s);
  const std::string facets = outcome.facets > 0 ? fmt::format(", {} facets", outcome.facets) : "";
  return fmt::format("Search: {} nodes, {} linear programs{}, {:.3g} s{}\n", outcome.nodes,
                     outcome.programs, facets, design_s,
                     outcome.stopped ? ", ended by the limit" : "");
}

std::string exact_text(const Names& modes, const ExactSeparation& exact, const Paint& paint) {
  std::string text;
  for (const ExactPair& pair : exact.pairs) {
    if (!pair.reason.empty())
      text += fmt::format("Not decided exactly: {}: {}\n", pair_name(modes, pair.i, pair.j),
                          pair.reason);
  }
  for (std::size_t i = 0; i < exact.empty.size(); ++i) {
    if (exact.empty[i] == Answer::unknown)
      text += fmt::format("Not decided exactly: has {} an output at all?\n", modes[i]);
  }
  const Answer separates = exact.separates();
  const std::string verdict = separates == Answer::yes  ? paint.green("the modes are separated")
                              : separates == Answer::no ? paint.red("the modes are not separated")
                                                        : paint.yellow("separation is not proven");
  return text + fmt::format("In exact arithmetic: {} ({:.3g} s)\n", verdict, exact.wall_s);
}

std::string refuted_text(const Names& refuted, const Paint& paint) {
  std::string text;
  for (const std::string& claim : refuted) text += paint.red("Proven false") + ": " + claim + "\n";
  return text;
}

/// What there is to say of an input: the sequence, the pairs of modes, and what is proven of them.
std::string input_text(const Names& modes, const InputDesign& best, const ExactSeparation* exact,
                       const Paint& paint) {
  std::string text = fmt::format("\n{}\n{}\n", inputs_table(best.u, paint),
                                 pairs_table(modes, best, exact, paint));
  const Names empty = empty_modes(modes, best.empty, exact);
  if (!empty.empty()) text += paint.red("Modelling error") + ": " + empty_text(empty) + "\n";
  return exact ? text + exact_text(modes, *exact, paint) : text;
}

std::string design_text(const Names& modes, const PipelineDesign& design, const Paint& paint) {
  std::string text =
      fmt::format("{}  {}, {}\n", paint.bold(design.name), design.backend, design.designer);
  if (design.outcome) {
    const DesignOutcome& outcome = *design.outcome;
    const ExactSeparation* exact = design.exact ? &*design.exact : nullptr;
    text += status_text(outcome, design.designer, exact, paint) + "\n" + restriction_text(outcome) +
            horizon_text(outcome) + reason_text(outcome);
    if (outcome.best) text += input_text(modes, *outcome.best, exact, paint);
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

/// Why experiments may have stayed open: samples after the horizon of `tube_membership` decide
/// nothing.
std::string unused_samples_text(const Study& study, const PipelineOutcome& pipeline) {
  const auto spec =
      std::find_if(study.pipelines.begin(), study.pipelines.end(),
                   [&](const PipelineSpec& candidate) { return candidate.name == pipeline.name; });
  const bool undecided = std::any_of(pipeline.experiments.begin(), pipeline.experiments.end(),
                                     [](const ExperimentRow& row) { return row.undecided > 0; });
  if (!undecided || spec == study.pipelines.end() || !spec->diagnoser ||
      spec->diagnoser->type != "tube_membership")
    return "";
  const Index last = spec->diagnoser->params.integer("horizon"), needed = pipeline.design->horizon;
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
  const Names modes = mode_names(study);
  std::string text = study.title.empty() ? "" : paint.bold(study.title) + "\n";
  for (const PipelineDesign& design : designs) {
    if (!text.empty()) text += '\n';
    text += design_text(modes, design, paint);
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
  return report.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
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
  const auto& design = pipeline.design;
  if (!design || !design->best) return {};
  return empty_modes(mode_names(study), design->best->empty,
                     pipeline.exact ? &*pipeline.exact : nullptr);
}

std::string design_text(const Study& study, const PipelineOutcome& pipeline, const Paint& paint) {
  const Names modes = mode_names(study);
  const std::string diagnoser =
      pipeline.diagnoser.empty() ? "" : fmt::format(", {}", pipeline.diagnoser);
  std::string text = fmt::format("{}  {}, {}{}\n", paint.bold(pipeline.name), pipeline.backend,
                                 pipeline.designer, diagnoser);
  if (pipeline.design) {
    const DesignOutcome& outcome = *pipeline.design;
    const ExactSeparation* exact = pipeline.exact ? &*pipeline.exact : nullptr;
    text += status_text(outcome, pipeline.designer, exact, paint) + "\n" +
            restriction_text(outcome) + horizon_text(outcome) + reason_text(outcome);
    if (outcome.best) {
      text += input_text(modes, *outcome.best, exact, paint);
      if (pipeline.diagnoser.empty())
        text +=
            "\nNo experiments: name a \"diagnoser\" beside the designer to try the input on every "
            "mode\n";
    } else {
      text += "No experiments: there is no input to try\n";
    }
  }
  if (!pipeline.experiments.empty())
    text += fmt::format("\n{}", experiments_text(modes, pipeline.experiments, paint));
  text += refuted_text(pipeline.refuted, paint) + unused_samples_text(study, pipeline) +
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
