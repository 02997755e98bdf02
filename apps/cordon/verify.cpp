// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/verify.hpp"

#include <algorithm>
#include <csignal>
#include <memory>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "interrupt.hpp"
#include "json_text.hpp"
#include "progress_bar.hpp"

namespace cordon::apps {

namespace {

struct VerifyArguments {
  std::filesystem::path directory;
  VerifyOptions options;
  std::optional<double> limit_s = {};
  bool json = false, quiet = false;
};

/// Something of it was, or could have been; of a design without an input nothing can be: that there
/// is none is not proven again.
bool is_checked(const VerifiedPipeline& p) {
  return p.asked_for && (p.kind == PipelineKind::estimation ||
                         (p.kind == PipelineKind::diagnosis && !p.rests_on_more) ||
                         (p.kind == PipelineKind::design && p.proofs + p.undecided > 0));
}

using Count = SecondOpinionFindings::Count;

std::string second_opinion_text(const SecondOpinionFindings& found, const Paint& paint) {
  std::vector<std::vector<std::string>> rows{
      {found.engine, "agree", "too large", "unanswered", "disagree"}};
  for (const auto& [what, count] : {std::pair<const char*, Count>{"conversions", found.conversions},
                                    {"linear programs", found.programs}}) {
    rows.push_back({what, std::to_string(count.agree), std::to_string(count.too_large),
                    std::to_string(count.unanswered), std::to_string(count.disagree)});
  }
  return "\n" + table(rows, paint);
}

/// The sentence on the first question that both engines answer differently, or "".
const std::string& disagreement(const VerifyOutcome& outcome) {
  static const std::string none;
  return outcome.second_opinion ? outcome.second_opinion->first_disagreement : none;
}

nlohmann::ordered_json second_opinion_json(const SecondOpinionFindings& found) {
  using Object = nlohmann::ordered_json;
  const auto count_json = [](const Count& count) {
    return Object{{"agree", count.agree},
                  {"too_large", count.too_large},
                  {"unanswered", count.unanswered},
                  {"disagree", count.disagree}};
  };
  return {{"engine", found.engine},
          {"conversions", count_json(found.conversions)},
          {"programs", count_json(found.programs)},
          {"first_disagreement", found.first_disagreement},
          {"first_unanswered", found.first_unanswered}};
}

std::string report_text(const VerifyOutcome& outcome, const Paint& paint) {
  std::vector<std::vector<std::string>> rows{{"pipeline", "backend", "rounding", "steps",
                                              "exact sets", "directions", "proofs", "exact claims",
                                              "undecided"}};
  std::string passed_over;
  for (const VerifiedPipeline& p : outcome.pipelines) {
    if (!p.asked_for) {
      passed_over += fmt::format("not asked for: {}\n", p.name);
      continue;
    }
    if (!p.failed_assumption.empty()) {
      passed_over += fmt::format(
          "{} of {}: {}. What is said from k = {} on rests on it and proves nothing{}\n",
          paint.yellow("assumption failed"), p.name, p.failed_assumption, p.assumptions_until,
          p.fails_again == Answer::yes ? " (proven again)" : "");
    }
    if (!is_checked(p)) {
      passed_over += fmt::format("not re-checked: {} ({})\n", p.name,
                                 p.kind == PipelineKind::diagnosis
                                     ? "a diagnosis that rests on bounds of errors, or by an older "
                                       "version"
                                     : "nothing of its design is proven again");
      continue;
    }
    if (p.kind == PipelineKind::design)
      passed_over += fmt::format(
          "not re-checked: the experiments of {} (of its design, the separation is)\n", p.name);
    if (p.kind == PipelineKind::diagnosis) {
      passed_over +=
          fmt::format("{} exclusions of modes and {} boxes of the state of {} are proven again\n",
                      p.exclusions, p.states, p.name);
    }
    if (p.from_told_sets) {
      passed_over += fmt::format(
          "not re-checked: that the sets from which the modes of {} begin anew hold the state\n",
          p.name);
    }
    if (p.not_compared > 0) {
      passed_over += fmt::format(
          "not re-checked: that the sets of {} of {}, which know later samples, hold every state, "
          "and claims of \"exact\" (their proofs are checked)\n",
          count(p.not_compared, "step"), p.name);
    }
    if (p.exact_claims_unproven > 0) {
      passed_over += fmt::format(
          "not proven: {} claims of \"exact\" of {}, held against directions only, which can "
          "refute them, or not at all where model and data leave no state or doubles do not hold "
          "the set\n",
          p.exact_claims_unproven, p.name);
    }
    if (p.by_supports > 0 && !outcome.of_formulas) {
      passed_over += fmt::format(
          "evidence only: {} steps of {} are held against the exact set along directions; whole, "
          "that set is too large\n",
          p.by_supports, p.name);
    }
    rows.push_back({p.name, p.backend, std::string(to_string(p.rounding)), std::to_string(p.steps),
                    std::to_string(p.by_polytopes), std::to_string(p.by_supports),
                    std::to_string(p.proofs + p.exclusions + p.states),
                    std::to_string(p.exact_claims), std::to_string(p.undecided)});
  }
  if (outcome.of_formulas) {
    passed_over += "successors by formulas are drawn: checked for some of them, not for all\n";
  } else if (outcome.by_samples) {
    passed_over +=
        "matrices are known by intervals only: checked for some drawn from them, not for all; "
        "claims of \"exact\" are not "
        "checked\n";
  }
  return (rows.size() > 1 || passed_over.empty() ? table(rows, paint) : "") + passed_over +
         (outcome.second_opinion ? second_opinion_text(*outcome.second_opinion, paint) : "");
}

nlohmann::ordered_json assumption_json(const VerifiedPipeline& p) {
  if (p.failed_assumption.empty()) return nullptr;
  return {{"text", p.failed_assumption},
          {"assumptions_until", p.assumptions_until},
          {"proven_again", to_string(p.fails_again)}};
}

/// Was anything checked, and did all of it hold?
bool is_verified(const VerifyOutcome& outcome) {
  const auto& all = outcome.pipelines;
  return !outcome.violation && disagreement(outcome).empty() &&
         std::any_of(all.begin(), all.end(), is_checked) &&
         std::all_of(all.begin(), all.end(),
                     [](const VerifiedPipeline& p) { return p.undecided == 0; });
}

std::string report_json(const VerifyOutcome& outcome) {
  using Object = nlohmann::ordered_json;
  Object report{{"verified", is_verified(outcome)},
                {"by_samples", outcome.by_samples},
                {"pipelines", Object::array()},
                {"violation", nullptr},
                {"second_opinion", nullptr}};
  for (const VerifiedPipeline& p : outcome.pipelines) {
    report["pipelines"].push_back({{"name", p.name},
                                   {"backend", p.backend},
                                   {"rounding", to_string(p.rounding)},
                                   {"checked", is_checked(p)},
                                   {"steps", p.steps},
                                   {"by_polytopes", p.by_polytopes},
                                   {"by_supports", p.by_supports},
                                   {"not_compared", p.not_compared},
                                   {"proofs", p.proofs},
                                   {"exclusions", p.exclusions},
                                   {"states", p.states},
                                   {"from_told_sets", p.from_told_sets},
                                   {"exact_claims", p.exact_claims},
                                   {"exact_claims_unproven", p.exact_claims_unproven},
                                   {"undecided", p.undecided},
                                   {"first_undecided", p.first_undecided},
                                   {"failed_assumption", assumption_json(p)}});
  }
  if (const auto& v = outcome.violation) {
    report["violation"] = {
        {"pipeline", v->pipeline}, {"k", v->k}, {"what", v->what}, {"pointer", v->pointer}};
  }
  if (const auto& found = outcome.second_opinion)
    report["second_opinion"] = second_opinion_json(*found);
  return json_text(report);
}

std::int64_t undecided(const VerifyOutcome& outcome) {
  std::int64_t count = 0;
  for (const VerifiedPipeline& p : outcome.pipelines) {
    if (p.undecided > 0)
      warn(fmt::format("pipeline \"{}\": undecided at {}", p.name, p.first_undecided));
    count += p.undecided;
  }
  return count;
}

std::string final_text(const VerifyOutcome& outcome) {
  const bool assumed =
      std::none_of(outcome.pipelines.begin(), outcome.pipelines.end(),
                   [](const VerifiedPipeline& p) { return !p.failed_assumption.empty(); });
  return assumed ? "Every claim that was checked holds.\n"
                 : "Every claim that was checked holds, as long as its assumptions do.\n";
}

Exit verify(VerifyArguments& arguments) {
  VerifyOptions& options = arguments.options;
  const bool visible = !arguments.quiet && isatty(STDERR_FILENO) == 1;
  std::optional<ProgressBar> bar;
  options.progress = [&](const std::vector<std::string>& names, std::size_t pipeline,
                         std::int64_t done, std::int64_t total) {
    if (!bar) bar.emplace(names, visible);
    bar->show(pipeline, done, total);
  };
  options.stop = stop_on_signals();
  if (arguments.limit_s) options.deadline = time_after(*arguments.limit_s);
  const VerifyOutcome outcome = verify_run(arguments.directory, options);
  if (bar) bar->clear();
  if (outcome.interrupted) {
    complain("interrupted: the run is not verified");
    return interrupted;
  }
  if (!arguments.quiet)
    print(arguments.json ? report_json(outcome) : report_text(outcome, Paint(stdout)));
  if (const auto& v = outcome.violation) {
    complain(fmt::format("violated at {}, pipeline \"{}\", k = {}: {}", v->pointer, v->pipeline,
                         v->k, v->what));
    return Exit::violated;
  }
  if (const std::string& differs = disagreement(outcome); !differs.empty()) {
    complain(fmt::format("{} does not agree, {}", outcome.second_opinion->engine, differs));
    return Exit::violated;
  }
  if (outcome.second_opinion && !outcome.second_opinion->first_unanswered.empty())
    warn("no second opinion, " + outcome.second_opinion->first_unanswered);
  if (const std::int64_t open = undecided(outcome); open > 0) {
    complain(count(open, "check") + " could not be decided; all others hold");
    return Exit::unanswered;
  }
  const bool any = std::any_of(
      outcome.pipelines.begin(), outcome.pipelines.end(),
      [](const VerifiedPipeline& p) { return is_checked(p) || !p.failed_assumption.empty(); });
  if (!any && !outcome.pipelines.empty()) {
    complain("nothing was checked: estimates and designed inputs are, and there are none here");
    return Exit::unanswered;
  }
  if (!arguments.quiet && !arguments.json) print(final_text(outcome));
  return Exit::done;
}

}  // namespace

CORDON_COMMAND(verify) {
  CLI::App* command =
      app.add_subcommand("verify", "Check the results of a run again, in exact arithmetic");
  const auto arguments = std::make_shared<VerifyArguments>();
  command->add_option("DIR", arguments->directory, "Directory that \"cordon run\" wrote")
      ->required()
      ->check(CLI::Validator(path_problem, "", ""));
  command->add_option("--every", arguments->options.every, "Check every M-th step")
      ->option_text("M [1]")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000'000}));
  command
      ->add_option("--directions", arguments->options.directions,
                   "Random directions where exact polytopes are too large")
      ->option_text("N [32]")
      ->check(CLI::Range(0, 100000));
  command->add_option("--seed", arguments->options.seed, "Seed of these directions")
      ->option_text("N [1]");
  command
      ->add_option("--pipeline", arguments->options.pipelines,
                   "Check this pipeline only (may be repeated)")
      ->option_text("NAME")
      ->allow_extra_args(false);
  command
      ->add_option("--time-limit", arguments->limit_s,
                   "End after this time; what is not checked by then is undecided")
      ->option_text("SECONDS")
      ->check(CLI::Validator(time_problem, "", ""));
  command->add_flag("--second-opinion", arguments->options.second_opinion,
                    "Repeat conversions of polyhedra and exact linear programs by cddlib");
  command->add_flag("--json", arguments->json, "Print JSON for programs instead of the table");
  command->add_flag("--quiet", arguments->quiet, "Print errors only");
  command->footer(
      "Checks for each step that the reported set and hull contain every state that model, data "
      "and the pipeline's own\n"
      "assumptions allow, that the stored proofs hold, and that claims of \"exact\" are true; of "
      "designed inputs, what is said "
      "of\n"
      "pairs of modes and of empty tubes (their experiments are not re-checked); of banks by sets, "
      "that modes are excluded\n"
      "and where the state is. No plugin is loaded.\n"
      "Exit code 4 and the first violation if a claim is false, or the first question on which "
      "cddlib does not agree; 5 if\n"
      "a check could not be decided, or nothing was checked.");
  command->callback([&program, arguments] { program.exit = verify(*arguments); });
}

}  // namespace cordon::apps
