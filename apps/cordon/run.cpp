// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/run.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.hpp"
#include "cordon/experiments/report.hpp"
#include "interrupt.hpp"
#include "progress_bar.hpp"
#include "run_failures.hpp"
#include "run_report.hpp"
#include "run_sweep.hpp"

namespace cordon::apps {

namespace {

constexpr KeptSets kinds_of_sets[] = {KeptSets::all, KeptSets::last, KeptSets::none};

/// Empty for the name of one of them; else what is wrong.
std::string sets_problem(const std::string& text) {
  std::vector<std::string> names;
  for (const KeptSets kept : kinds_of_sets) names.emplace_back(to_string(kept));
  if (std::find(names.begin(), names.end(), text) != names.end()) return "";
  return fmt::format("\"{}\" is no choice; {}", text, suggest(text, names));
}

std::filesystem::path directory_for(const RunArguments& arguments) {
  if (!arguments.out.empty()) return arguments.out;
  const std::string name = arguments.study.stem().string();
  if (arguments.point)
    return std::filesystem::path("results") / fmt::format("{}-point-{}", name, *arguments.point);
  if (arguments.shard.empty()) return std::filesystem::path("results") / name;
  const Shard shard = shard_of(arguments.shard);
  return std::filesystem::path("results") /
         fmt::format("{}-part-{}-of-{}", name, shard.part, shard.of);
}

Exit run_once(const Study& study, const Registry& registry, const RunArguments& arguments,
              const std::atomic<bool>* stop) {
  std::vector<std::string> names;
  for (const PipelineSpec& pipeline : study.pipelines) names.push_back(pipeline.name);
  ProgressBar bar(names, !arguments.quiet && isatty(STDERR_FILENO) == 1);
  RunOptions options;
  options.stop = stop;
  options.out = directory_for(arguments);
  if (!arguments.no_report) options.report = cordon::add_report;
  for (const KeptSets kept : kinds_of_sets) {
    if (arguments.sets == to_string(kept)) options.sets = kept;
  }
  if (!arguments.quiet) {
    options.many_sets = [&](double bytes) {
      bar.clear();
      warn(fmt::format(
          "sets.jsonl {}; --sets last keeps the last set of each pipeline, --sets "
          "none keeps none (cordon verify needs all)",
          bytes > 0
              ? fmt::format("will take about {:.0f} MB, going by the sets so far", bytes / 1e6)
              : "has taken 100 MB"));
    };
  }
  if (arguments.point_limit_s) options.deadline = time_after(*arguments.point_limit_s);
  options.progress = [&](std::size_t pipeline, std::int64_t done, std::int64_t total) {
    bar.show(pipeline, done, total);
  };
  const RunOutcome outcome = run_study(study, registry, options);
  bar.clear();
  if (outcome.interrupted) {
    complain(fmt::format("interrupted: nothing was written; earlier results in {} are unchanged",
                         options.out.string()));
    return interrupted;
  }
  if (!arguments.quiet)
    print(arguments.json ? report_json(study, outcome) : report_text(study, outcome, options.out));
  for (const std::string& complaint : complaints(study, outcome)) complain(complaint);
  if (!outcome.report_error.empty()) warn(no_report + outcome.report_error);
  return exit_of(outcome);
}

Exit run(const Program& program, const RunArguments& arguments) {
  const std::atomic<bool>* const stop =
      stop_on_signals();  // reading checks what was read, which may take a while
  Registry registry;
  registry.load({program.plugins});  // the study's own directories and the usual ones follow
  const Study study = read_study(arguments.study, registry, default_search_path(),
                                 program.study_plugins(), StudyData::needed, arguments.settings);
  check_options(arguments, study);
  if (!arguments.quiet) {
    for (const std::string& warning : study.warnings) warn(warning);
  }
  if (arguments.point) {
    return run_once(study_at(study, SweepGrid(study)[*arguments.point], registry), registry,
                    arguments, stop);
  }
  if (study.sweep.empty()) return run_once(study, registry, arguments, stop);
  return run_all_points(study, registry, arguments, directory_for(arguments), stop);
}

void add_sweep_options(CLI::App& command, const std::shared_ptr<RunArguments>& arguments) {
  const char* const group = "Sweeps (studies with a \"sweep\"; docs/sweeps.md)";
  command.add_option("--jobs", arguments->jobs, "Points at a time [the number of cores]")
      ->check(CLI::Range(1, 1024))
      ->option_text("N")
      ->group(group);
  command.add_flag("--resume", arguments->resume, "Go on after what an interrupted run has left")
      ->group(group);
  command.add_flag("--restart", arguments->restart, "Throw away what an interrupted run has left")
      ->group(group);
  command.add_option("--point-limit", arguments->point_limit_s, "Give a point up after this time")
      ->check(CLI::Validator(time_problem, "", ""))
      ->option_text("SECONDS")
      ->group(group);
  command.add_option("--shard", arguments->shard, "Run part I of N parts; cordon merge joins them")
      ->option_text("I/N")
      ->group(group);
  command
      .add_option("--point", arguments->point,
                  "Run this one point like a study of its own, with all files")
      ->option_text("INDEX")
      ->group(group);
}

}  // namespace

CORDON_COMMAND(run) {
  CLI::App* command = app.add_subcommand("run", "Run a study and compare its pipelines");
  const auto arguments = std::make_shared<RunArguments>();
  command->add_option("STUDY", arguments->study, "Study file (JSON)")->required()->option_text(" ");
  command
      ->add_option(
          "--out", arguments->out,
          "Directory for the results, in place of earlier ones [results/<name of the study>]")
      ->check(CLI::Validator(path_problem, "", ""))
      ->option_text("DIR");
  command->add_flag("--json", arguments->json, "Print JSON for programs instead of tables");
  command->add_flag("--quiet", arguments->quiet, "Print errors only");
  command->add_flag("--no-report", arguments->no_report, "Write no report.html");
  command
      ->add_option("--set", arguments->settings,
                   "Put a value into the study, may be repeated: --set /data/simulate/seed=3")
      ->option_text("/PATH=VALUE")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--sets", arguments->sets,
          "Whose sets sets.jsonl keeps: those of all steps, of the last one, or none [all]")
      ->check(CLI::Validator(sets_problem, "", ""))
      ->option_text("all|last|none");
  add_sweep_options(*command, arguments);
  command->footer(
      "Results appear when all are complete: results.json, sets.jsonl, data.csv, steps.csv, "
      "summary.csv, run.json, and\n"
      "diagnosis.csv where there are diagnosers: they are tried on all seeds of the study, and the "
      "first is written.\n"
      "report.html follows, unless --no-report is given.\n"
      "Where there are designers, inputs.csv holds what they designed; a diagnoser beside one is "
      "tried on every mode with it.\n"
      "A sweep writes results.json, points.csv and run.json, and keeps finished points while it "
      "runs: killed at any time, it\n"
      "goes on with --resume.\n"
      "One run at a time writes into a directory: a second one is told so, and ends with exit code "
      "2.\n"
      "SIGINT or SIGTERM ends the run with exit code 130 and leaves earlier results as they were; "
      "a second one kills.");
  command->callback([&program, arguments] { program.exit = run(program, *arguments); });
}

}  // namespace cordon::apps
