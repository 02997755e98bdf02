// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "design_outcome_text.hpp"
#include "diagnosis_report.hpp"
#include "json_text.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;

struct GuaranteesArguments {
  std::filesystem::path study;
  std::string pipeline;
  bool json = false;
};

/// What one pipeline promises before any experiment.
struct Promise {
  const PipelineSpec* pipeline;
  const ComponentSpec* diagnoser;  ///< also that of experiments; null: there is none
  std::optional<Guarantees> guarantees = {};
};

const ComponentSpec* diagnoser_of(const PipelineSpec& pipeline) {
  for (const auto& [kind, component] : algorithms_of(pipeline)) {
    if (kind == "diagnoser") return component;
  }
  return nullptr;
}

std::vector<Promise> promises(const Study& study, const Registry& registry,
                              const std::string& name) {
  std::vector<Promise> found;
  for (const PipelineSpec* pipeline : pipelines_called(study, name)) {
    const ComponentSpec* const diagnoser = diagnoser_of(*pipeline);
    found.push_back({pipeline, diagnoser});
    if (!diagnoser) continue;
    const auto backend =
        registry.make<BackendEntry>(pipeline->backend.type, pipeline->backend.params);
    found.back().guarantees =
        registry
            .make<DiagnoserEntry>(diagnoser->type, {bank_of(study), backend}, diagnoser->params)
            ->guarantees();
  }
  return found;
}

std::string report_text(const Study& study, const std::vector<Promise>& all) {
  const Paint paint(stdout);
  std::string text = study.title.empty() ? "" : paint.bold(study.title) + "\n";
  for (const auto& [pipeline, diagnoser, guarantees] : all) {
    if (!text.empty()) text += "\n";
    if (!diagnoser) {
      text += fmt::format("{}  has no diagnoser\n", paint.bold(pipeline->name));
      continue;
    }
    text += fmt::format("{}  {}, {}\n", paint.bold(pipeline->name), pipeline->backend.type,
                        diagnoser->type);
    text += guarantees ? guarantees_text(*guarantees, study.labels, mode_names(study), paint)
                       : fmt::format("{} makes no statements in advance\n", diagnoser->type);
  }
  return text;
}

std::string report_json(const Study& study, const std::vector<Promise>& all) {
  const std::vector<std::string> modes = mode_names(study);
  Json report{{"modes", modes}, {"pipelines", Json::array()}};
  for (const auto& [pipeline, diagnoser, guarantees] : all) {
    report["pipelines"].push_back(
        {{"name", pipeline->name},
         {"backend", pipeline->backend.type},
         {"diagnoser", diagnoser ? Json(diagnoser->type) : Json(nullptr)},
         {"guarantees", guarantees ? Json::parse(json_of(*guarantees, modes)) : Json(nullptr)}});
  }
  return json_text(report);
}

Exit guarantees(const Program& program, const GuaranteesArguments& arguments) {
  Registry registry;
  registry.load({program.plugins});
  const Study study = read_study(arguments.study, registry, default_search_path(),
                                 program.study_plugins(), StudyData::optional);
  for (const std::string& warning : study.warnings) warn(warning);
  const std::vector<Promise> all = promises(study, registry, arguments.pipeline);
  print(arguments.json ? report_json(study, all) : report_text(study, all));
  return Exit::done;
}

}  // namespace

CORDON_COMMAND(guarantees) {
  CLI::App* command = app.add_subcommand(
      "guarantees", "Say which faults of a study can be told apart, before any experiment");
  const auto arguments = std::make_shared<GuaranteesArguments>();
  command->add_option("STUDY", arguments->study, "Study file (JSON)")->required()->option_text(" ");
  command->add_option("--pipeline", arguments->pipeline, "This pipeline only")->option_text("NAME");
  command->add_flag("--json", arguments->json, "Print JSON for programs instead of tables");
  command->footer(
      "For each observer of a bank and each true mode: the set that holds all residuals in steady "
      "state, and whether the\n"
      "observer of the true mode is consistent with it and the others are not. \"not guaranteed\" "
      "means that this was not\n"
      "shown, \"no\" that 0 is proven to lie in the limit of that set, which may be larger than\n"
      "what residuals can be. The exit code is 0 whatever the answer.");
  command->callback([&program, arguments] { program.exit = guarantees(program, *arguments); });
}

}  // namespace cordon::apps
