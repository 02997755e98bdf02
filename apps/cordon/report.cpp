// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/experiments/report.hpp"

#include <memory>

#include <CLI/CLI.hpp>

#include "commands.hpp"

namespace cordon::apps {

namespace {

struct ReportArguments {
  std::filesystem::path directory;
  ReportOptions options;
  bool quiet = false;
};

Exit report(const ReportArguments& arguments) {
  std::string text;
  for (const std::filesystem::path& file : write_report(arguments.directory, arguments.options))
    text += file.string() + '\n';
  if (!arguments.quiet) print(text);
  return Exit::done;
}

}  // namespace

CORDON_COMMAND(report) {
  CLI::App* command = app.add_subcommand("report", "Draw the figures of a finished run or sweep");
  const auto arguments = std::make_shared<ReportArguments>();
  command->add_option("DIR", arguments->directory, "Directory of the results")
      ->required()
      ->check(CLI::Validator(path_problem, "", ""))
      ->option_text(" ");
  command->add_flag("--svg", arguments->options.svg, "Write every figure as figures/NAME.svg too");
  command->add_flag("--pdf", arguments->options.pdf, "Write every figure as figures/NAME.pdf too");
  command->add_flag("--csv", arguments->options.csv,
                    "Write the numbers of every figure as figures/NAME.csv too");
  command->add_flag("--quiet", arguments->quiet, "Do not print the names of the files");
  command->footer(
      "Writes report.html, one file that needs nothing else, from the files in DIR; no plugin is "
      "loaded. On the page long "
      "curves\n"
      "are thinned out so that bands still enclose what they stand for; tables of figures hold "
      "every number.");
  command->callback([&program, arguments] { program.exit = report(*arguments); });
}

}  // namespace cordon::apps
