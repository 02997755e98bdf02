// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "cordon/core/error.hpp"
#include "cordon/core/tolerances.hpp"
#include "cordon/interfaces/nonlinear_model.hpp"
#include "cordon/study/region.hpp"
#include "json_text.hpp"
#include "linearised_study.hpp"
#include "model_json.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;

struct LineariseArguments {
  std::filesystem::path study, region, write;
  bool json = false;
};

/// The bounds of the mode's parameters that are states stand behind those of the other states.
Box states_of_mode(const Box& states, const Model& model) {
  const Index parameters = model.nonlinear->parameters, others = states.dim();
  const Vector c = model.X0.c.tail(parameters),
               r = model.X0.G.bottomRows(parameters).cwiseAbs().rowwise().sum(),
               room = tolerances::reported * (c.cwiseAbs() + r);  // for the rounding of hulls
  Box all{Vector(others + parameters), Vector(others + parameters)};
  all.lower << states.lower, c - r - room;
  all.upper << states.upper, c + r + room;
  return all;
}

std::string range_of(Interval x) { return fmt::format("[{:.6g}, {:.6g}]", x.lower, x.upper); }

std::string proven_where(const Study& study, const ValidRegion& region) {
  std::string text = "Proven where ";
  const auto add = [&](const Labels::Names& names, const char* symbol, const Box& box) {
    for (Index i = 0; i < box.dim(); ++i) {
      if (text.back() != ' ') text += ", ";
      text += fmt::format("{} is in {}", label_of(names, symbol, i),
                          range_of({box.lower[i], box.upper[i]}));
    }
  };
  add(study.labels.states, "x", region.states);
  add(study.labels.inputs, "u", region.inputs);
  return text + "\n";
}

/// The errors of a mode: constants are no errors.
void add_errors(std::vector<std::vector<std::string>>& table, const std::string& mode,
                const Labels::Names& names, const char* symbol,
                const std::vector<LinearisedRow>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Interval left = rows[i].remainder, attained = rows[i].attained;
    const double center = 0.5 * left.lower + 0.5 * left.upper;
    std::vector<std::string> line{label_of(names, symbol, static_cast<Index>(i)),
                                  fmt::format("{:.6g}", center),
                                  fmt::format("{:.4g}", 0.5 * (left.upper - left.lower)),
                                  fmt::format("{:.4g}", 0.5 * (attained.upper - attained.lower))};
    if (!mode.empty()) line.insert(line.begin(), mode);
    table.push_back(std::move(line));
  }
}

std::string linearised_text(const Study& study, const std::vector<Linearised>& linear) {
  const Paint paint(stdout);
  const bool has_modes = !study.modes.empty();
  std::string text = study.title.empty() ? "" : paint.bold(study.title) + "\n";
  text += proven_where(study, *linear.front().model.region) + "\n";
  std::vector<std::vector<std::string>> rows{{"ROW", "CONSTANT", "ERROR ±", "ATTAINED"}};
  if (has_modes) rows.front().insert(rows.front().begin(), "MODE");
  for (std::size_t j = 0; j < linear.size(); ++j) {
    const std::string mode = !has_modes ? "" : j == 0 ? study.nominal : study.modes[j - 1].name;
    add_errors(rows, mode, study.labels.states, "x", linear[j].f);
    add_errors(rows, mode, study.labels.outputs, "y", linear[j].g);
  }
  return text + table(rows, paint);
}

Json errors_json(const std::vector<LinearisedRow>& rows) {
  Json list = Json::array();
  for (const LinearisedRow& row : rows) {
    list.push_back({{"remainder", {row.remainder.lower, row.remainder.upper}},
                    {"attained", {row.attained.lower, row.attained.upper}}});
  }
  return list;
}

std::string linearised_json(const Study& study, const std::vector<Linearised>& linear) {
  Json report;
  for (std::size_t j = 0; j < linear.size(); ++j) {
    const LinearModel& m = linear[j].model.linear;
    const ValidRegion& region = *linear[j].model.region;
    report["modes"].push_back({{"name", j == 0 ? study.nominal : study.modes[j - 1].name},
                               {"A", rows_of(m.A)},
                               {"B", rows_of(m.B)},
                               {"Bw", rows_of(m.Bw)},
                               {"C", rows_of(m.C)},
                               {"D", rows_of(m.D)},
                               {"Dv", rows_of(m.Dv)},
                               {"f", errors_json(linear[j].f)},
                               {"g", errors_json(linear[j].g)},
                               {"states", bounds_of(region.states)},
                               {"inputs", bounds_of(region.inputs)},
                               {"nonlinear_outputs", region.nonlinear_outputs}});
  }
  return json_text(report);
}

Exit linearise_study(const Program& program, const LineariseArguments& arguments) {
  Registry registry;
  registry.load({program.plugins});
  const Study study = read_study(arguments.study, registry, default_search_path(),
                                 program.study_plugins(), StudyData::optional);
  for (const std::string& warning : study.warnings) warn(warning);
  const ValidRegion region = read_region(arguments.region, study.model);
  if (study.model.nonlinear->undefined == formulas::Undefined::assumed)
    warn("\"domain\": \"assumed\" is not used: formulas have to be defined on the whole region");
  std::vector<Linearised> linear;
  const ModeBank bank = bank_of(study);
  for (const Mode& mode : bank.modes)
    linear.push_back(
        linearise(mode.model, states_of_mode(region.states, mode.model), region.inputs));
  print(arguments.json ? linearised_json(study, linear) : linearised_text(study, linear));
  if (!arguments.write.empty()) {
    write_linearised(study, linear, arguments.write);
    note(fmt::format("Wrote {}", arguments.write.string()));
  }
  return Exit::done;
}

}  // namespace

CORDON_COMMAND(linearise) {
  CLI::App* command =
      app.add_subcommand("linearise", "Make linear models of formulas that are proven in a region");
  const auto arguments = std::make_shared<LineariseArguments>();
  command->add_option("STUDY", arguments->study, "Study file (JSON)")->required()->option_text(" ");
  command
      ->add_option("--region", arguments->region,
                   "JSON file with bounds of the states and inputs: "
                   "{\"states\": {\"lower\": [...], \"upper\": [...]}, \"inputs\": {...}}")
      ->required()
      ->option_text("FILE");
  command
      ->add_option("--write", arguments->write,
                   "Write a study of the linear models to a new file; the formulas make its data")
      ->option_text("FILE");
  command->add_flag("--json", arguments->json, "Print JSON for programs instead of tables");
  command->footer(
      "ERROR is half the width of what a linear row leaves out of the formula, proven for all "
      "points of the region;\nATTAINED is how much of it points of the region need.");
  command->callback([&program, arguments] { program.exit = linearise_study(program, *arguments); });
}

}  // namespace cordon::apps
