// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/experiments/compare.hpp"

#include <memory>

#include <CLI/CLI.hpp>

#include "commands.hpp"
#include "compare_report.hpp"

namespace cordon::apps {

namespace {

struct CompareArguments {
  std::vector<std::filesystem::path> directories;
  bool json = false, markdown = false, csv = false;
};

Exit compare(const CompareArguments& arguments) {
  const Comparison comparison = compare_results(arguments.directories);
  if (arguments.json) {
    print(compare_json(comparison));
  } else if (arguments.csv) {
    print(compare_csv(comparison));
  } else {
    print(arguments.markdown ? compare_markdown(comparison) : compare_text(comparison));
  }
  if (!arguments.json && !arguments.markdown) {
    for (const std::string& warning : comparison.warnings) warn(warning);
  }
  return Exit::done;
}

}  // namespace

CORDON_COMMAND(compare) {
  CLI::App* command =
      app.add_subcommand("compare", "Compare finished runs or sweeps, also of different versions");
  const auto arguments = std::make_shared<CompareArguments>();
  command
      ->add_option("DIR", arguments->directories,
                   "Directories with results; the others are compared with the first")
      ->required()
      ->check(CLI::Validator(path_problem, "", ""))
      ->expected(2, 100)
      ->option_text("...");
  CLI::Option* json = command->add_flag("--json", arguments->json, "Print JSON for programs");
  CLI::Option* markdown =
      command->add_flag("--markdown", arguments->markdown, "Print tables in Markdown");
  CLI::Option* csv = command->add_flag("--csv", arguments->csv, "Print every number as CSV");
  json->excludes(markdown)->excludes(csv);
  markdown->excludes(csv);
  command->footer(
      "Numbers that repeat are equal or different; times are tested (Mann-Whitney), over the "
      "repetitions of sweeps or the steps\n"
      "of runs. The exit code tells of errors only.");
  command->callback([&program, arguments] { program.exit = compare(*arguments); });
}

}  // namespace cordon::apps
