// SPDX-License-Identifier: GPL-3.0-or-later
#include "cordon/study/design.hpp"

#include <memory>
#include <optional>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "commands.hpp"
#include "design_report.hpp"
#include "interrupt.hpp"
#include "progress_bar.hpp"

namespace cordon::apps {

namespace {

struct DesignArguments {
  std::filesystem::path study;
  DesignOptions options;
  bool verify = false, json = false, quiet = false;
};

Exit design(const Program& program, DesignArguments& arguments) {
  DesignOptions& options = arguments.options;
  options.stop = stop_on_signals();  // reading checks what was read, which may take a while
  Registry registry;
  registry.load({program.plugins});
  const Study study =
      read_study(arguments.study, registry, default_search_path(), program.study_plugins());
  if (!arguments.quiet) {
    for (const std::string& warning : study.warnings) warn(warning);
  }
  std::vector<std::string> names;
  for (const PipelineSpec& pipeline : study.pipelines) names.push_back(pipeline.name);
  ProgressBar bar(names, !arguments.quiet && isatty(STDERR_FILENO) == 1);
  options.progress = [&](std::size_t pipeline, Index horizon, double best, double bound) {
    bar.show(design_progress(names[pipeline], horizon, best, bound));
  };
  const std::vector<PipelineDesign> designs = design_study(study, registry, options);
  bar.clear();
  if (options.stop->load()) {
    complain("interrupted: nothing is reported");
    return interrupted;
  }
  if (designs.empty()) {
    throw InputError(study.file.string(), {{"/pipelines", "no pipeline has a designer",
                                            "add one: {\"backend\": …, \"designer\": …}"}});
  }
  if (!arguments.quiet)
    print(arguments.json ? designs_json(study, designs)
                         : designs_text(study, designs, Paint(stdout)));
  for (const std::string& complaint : complaints(study, designs, arguments.verify))
    complain(complaint);
  return exit_of(designs, arguments.verify);
}

}  // namespace

CORDON_COMMAND(design) {
  CLI::App* command =
      app.add_subcommand("design", "Design inputs that tell the modes of a study apart");
  const auto arguments = std::make_shared<DesignArguments>();
  command->add_option("STUDY", arguments->study, "Study file (JSON)")->required()->option_text(" ");
  command->add_option("--pipeline", arguments->options.pipeline, "This pipeline only")
      ->option_text("NAME");
  command->add_flag("--verify", arguments->verify,
                    "Do not be content with claims: exit code 5 where a proof stays open");
  command->add_flag("--json", arguments->json, "Print JSON for programs instead of tables");
  command->add_flag("--quiet", arguments->quiet, "Print errors only");
  command->footer(
      "An input separates two modes if no disturbances within their bounds give both the same "
      "outputs; κ tells by how much\n"
      "all bounds could grow. What is said of pairs is proven in exact arithmetic, from the "
      "study's own numbers and without the\n"
      "designer, or else called claimed; that no input is cheaper, or that there is none, is the "
      "designer's claim.\n"
      "Exit code 0 for every answer, infeasible included; 2 if the model contradicts itself under "
      "the input, so that a mode has\n"
      "no output at all; 4 if a claim is proven false, or the input is not what the study asks "
      "for; 5 if no input was found in "
      "the\n"
      "limit, or with --verify if the exact proof left a question open; 130 after SIGINT or "
      "SIGTERM, with nothing printed.");
  command->callback([&program, arguments] { program.exit = design(program, *arguments); });
}

}  // namespace cordon::apps
