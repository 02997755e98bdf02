// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.hpp"
#include "run_sweep.hpp"
#include "sweep_report.hpp"

namespace cordon::apps {

namespace {

struct MergeArguments {
  std::vector<std::filesystem::path> parts;
  std::filesystem::path out;
  bool json = false, quiet = false;
};

Exit merge(const MergeArguments& arguments) {
  const SweepOutcome outcome = merge_sweeps(arguments.parts, arguments.out);
  if (!arguments.quiet)
    print(arguments.json ? sweep_report_json(outcome)
                         : sweep_report_text(outcome, arguments.out, outcome.report_error.empty()));
  if (!outcome.report_error.empty()) warn(no_report + outcome.report_error);
  if (outcome.violated > 0)
    complain(fmt::format("a guarantee was violated at {} of {} points", outcome.violated,
                         outcome.progress.total));
  return exit_of(outcome);
}

}  // namespace

CORDON_COMMAND(merge) {
  CLI::App* command =
      app.add_subcommand("merge", "Join the parts of a sweep that were run with --shard");
  const auto arguments = std::make_shared<MergeArguments>();
  command->add_option("DIR", arguments->parts, "Directories of all parts, in any order")
      ->required()
      ->check(CLI::Validator(path_problem, "", ""))
      ->option_text(" ");
  command->add_option("--out", arguments->out, "Directory for the whole sweep")
      ->required()
      ->check(CLI::Validator(path_problem, "", ""))
      ->option_text("DIR");
  command->add_flag("--json", arguments->json, "Print JSON for programs instead of tables");
  command->add_flag("--quiet", arguments->quiet, "Print errors only");
  command->footer(
      "The files are those that one process would have left: the same bytes, but for times. Parts "
      "that are missing, that come\n"
      "twice, or that belong to other studies or builds are errors.");
  command->callback([&program, arguments] { program.exit = merge(*arguments); });
}

}  // namespace cordon::apps
