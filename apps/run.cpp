// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/run.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.hpp"
#include "interrupt.hpp"
#include "progress_bar.hpp"
#include "run_report.hpp"

namespace cordon::apps {

namespace {

struct Arguments {
  std::filesystem::path study, out;
  bool json = false, quiet = false;
};

Exit run(const Program& program, const Arguments& arguments) {
  RunOptions options;
  options.stop = stop_on_signals();  // reading checks what was read, which may take a while
  Registry registry;
  registry.load({program.plugins});  // the study's own directories and the usual ones follow
  const Study study = read_study(arguments.study, registry);
  if (!arguments.quiet) {
    for (const std::string& warning : study.warnings) warn(warning);
  }
  std::vector<std::string> names;
  for (const PipelineSpec& pipeline : study.pipelines) names.push_back(pipeline.name);
  ProgressBar bar(names, !arguments.quiet && isatty(STDERR_FILENO) == 1);
  options.out = arguments.out.empty() ? std::filesystem::path("results") / arguments.study.stem() : arguments.out;
  options.progress = [&](std::size_t pipeline, std::int64_t done, std::int64_t total) { bar.show(pipeline, done, total); };
  const RunOutcome outcome = run_study(study, registry, options);
  bar.clear();
  if (outcome.interrupted) {
    complain(fmt::format("interrupted: nothing was written; earlier results in {} are unchanged", options.out.string()));
    return interrupted;
  }
  if (!arguments.quiet) print(arguments.json ? report_json(study, outcome) : report_text(study, outcome, options.out));
  for (const std::string& complaint : complaints(study, outcome)) complain(complaint);
  return exit_of(outcome);
}

}  // namespace

void add_run(CLI::App& app, Program& program) {
  CLI::App* command = app.add_subcommand("run", "Run a study and compare its pipelines");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("STUDY", arguments->study, "Study file (JSON)")->required()->option_text(" ");
  command->add_option("--out", arguments->out, "Directory for the results [results/<name of the study>]")->option_text("DIR");
  command->add_flag("--json", arguments->json, "Print JSON for programs instead of tables");
  command->add_flag("--quiet", arguments->quiet, "Print errors only");
  command->footer(
      "Results appear when all are complete: results.json, sets.jsonl, data.csv, steps.csv, summary.csv, run.json, and\n"
      "diagnosis.csv where there are diagnosers: they are tried on all seeds of the study, and the first is written.\n"
      "Where there are designers, inputs.csv holds what they designed; a diagnoser beside one is tried on every mode with it.\n"
      "SIGINT or SIGTERM ends the run with exit code 130 and leaves earlier results as they were; a second one kills.");
  command->callback([&program, arguments] { program.exit = run(program, *arguments); });
}

}  // namespace cordon::apps
