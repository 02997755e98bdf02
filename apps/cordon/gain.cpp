// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "json_text.hpp"
#include "observer_report.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;

struct GainArguments {
  std::filesystem::path study;
  std::string pipeline;
  bool json = false;
};

/// The gains of one pipeline, or why they could not be had.
struct PipelineGains {
  const PipelineSpec* pipeline;
  std::vector<Gain> gains = {};
  std::string error = {};
};

std::vector<Gain> gains_of(const Study& study, const PipelineSpec& pipeline,
                           const Registry& registry) {
  const auto backend = registry.make<BackendEntry>(pipeline.backend.type, pipeline.backend.params);
  std::vector<Gain> gains;
  for (const auto& [kind, component] : algorithms_of(pipeline)) {
    if (kind == "observer") {
      gains =
          registry.make<ObserverEntry>(component->type, {study.model, backend}, component->params)
              ->gains();
    } else if (kind == "diagnoser") {
      gains =
          registry
              .make<DiagnoserEntry>(component->type, {bank_of(study), backend}, component->params)
              ->gains();
    }
  }
  return gains;
}

std::string report_text(const Study& study, const std::vector<PipelineGains>& all) {
  const Paint paint(stdout);
  std::string text = study.title.empty() ? "" : paint.bold(study.title) + "\n\n", rest;
  NamedGains rows;
  for (const auto& [pipeline, gains, error] : all) {
    rows.emplace_back(pipeline->name, gains);
    if (!error.empty()) {
      rest += fmt::format("{}  {}\n", paint.bold(pipeline->name), paint.red(error));
    } else if (gains.empty()) {
      rest += fmt::format("{}  works without a gain\n", paint.bold(pipeline->name));
    }
    for (const Gain& gain : gains)
      rest += fmt::format("{}  {}: {}\n", paint.bold(pipeline->name), gain.name,
                          matrix_json(gain.L).dump());
  }
  return text + gains_text(rows, paint) + rest;
}

std::string report_json(const std::vector<PipelineGains>& all) {
  Json report{{"pipelines", Json::array()}};
  for (const auto& [pipeline, gains, error] : all) {
    report["pipelines"].push_back({{"name", pipeline->name},
                                   {"gains", gains_json(gains)},
                                   {"error", error.empty() ? Json(nullptr) : Json(error)}});
  }
  return json_text(report);
}

Exit gain(const Program& program, const GainArguments& arguments) {
  Registry registry;
  registry.load({program.plugins});
  const Study study = read_study(arguments.study, registry, default_search_path(),
                                 program.study_plugins(), StudyData::optional);
  for (const std::string& warning : study.warnings) warn(warning);
  Exit exit = Exit::done;
  std::vector<PipelineGains> all;
  for (const PipelineSpec* pipeline : pipelines_called(study, arguments.pipeline)) {
    all.push_back({pipeline});
    try {
      all.back().gains = gains_of(study, *pipeline, registry);
    } catch (const Error& error) {
      all.back().error = error.what();
      if (exit == Exit::done) exit = exit_for(error.code());
    }
  }
  print(arguments.json ? report_json(all) : report_text(study, all));
  return exit;
}

}  // namespace

CORDON_COMMAND(gain) {
  CLI::App* command = app.add_subcommand(
      "gain", "Design and certify the gains of a study's observers; it needs no data");
  const auto arguments = std::make_shared<GainArguments>();
  command->add_option("STUDY", arguments->study, "Study file (JSON)")->required()->option_text(" ");
  command->add_option("--pipeline", arguments->pipeline, "This pipeline only")->option_text("NAME");
  command->add_flag("--json", arguments->json, "Print JSON for programs instead of tables");
  command->footer(
      "Matrices stand below the table as a study takes them: \"gain\": [[...], ...]. Of gains that "
      "follow the set it is that of\n"
      "the steady state. The spectral radius of the errors and the norm are proven bounds; "
      "\"cordon info gain NAME\" tells how a\n"
      "gain is designed. A study without \"data\" is enough. Of a sweep, the first values are "
      "taken.");
  command->callback([&program, arguments] { program.exit = gain(program, *arguments); });
}

}  // namespace cordon::apps
