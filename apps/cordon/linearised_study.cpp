// SPDX-License-Identifier: GPL-3.0-or-later
#include "linearised_study.hpp"

#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "json_text.hpp"
#include "model_json.hpp"
#include "new_file.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;

Json region_of(const ValidRegion& region) {
  Json json{{"states", bounds_of(region.states)}};
  if (region.inputs.dim() > 0) json["inputs"] = bounds_of(region.inputs);
  if (region.nonlinear_outputs) json["nonlinear_outputs"] = true;
  return json;
}

/// The set of a variable for each row that is not there.
Json nothing(Index rows) { return {{"type", "point"}, {"center", list_of(Vector::Zero(rows))}}; }

Json system_of(const Model& model) {
  const LinearModel& linear = model.linear;
  Json json{{"type", "lti"}, {"A", rows_of(linear.A)}};
  if (linear.inputs() > 0) json["B"] = rows_of(linear.B);
  if (linear.disturbances() > 0) json["Bw"] = rows_of(linear.Bw);
  json["C"] = rows_of(linear.C);
  if (linear.inputs() > 0) json["D"] = rows_of(linear.D);
  if (linear.noises() > 0) json["Dv"] = rows_of(linear.Dv);
  json["X0"] = set_of(model.X0);
  json["W"] = linear.disturbances() > 0 ? set_of(model.W) : nothing(linear.states());
  json["V"] = linear.noises() > 0 ? set_of(model.V) : nothing(linear.outputs());
  json["region"] = region_of(*model.region);
  return json;
}

/// Names of what was drawn for the formulas, and of the errors behind them.
Json names_with_errors(const Labels::Names& names, const char* symbol, Index of_formulas,
                       const Labels::Names& rows, const char* row_symbol,
                       const std::vector<Index>& kept) {
  Json all = Json::array();
  for (Index i = 0; i < of_formulas; ++i) all.push_back(label_of(names, symbol, i));
  for (const Index row : kept) all.push_back("error of " + label_of(rows, row_symbol, row));
  return all;
}

Json names_of(const Study& study, const Linearised& nominal) {
  const Labels& labels = study.labels;
  Json names = Json::object();
  if (!labels.states.empty()) names["states"] = labels.states;
  if (!labels.inputs.empty()) names["inputs"] = labels.inputs;
  if (!labels.outputs.empty()) names["outputs"] = labels.outputs;
  const LinearModel& linear = nominal.model.linear;
  if (linear.disturbances() > 0) {
    names["disturbances"] = names_with_errors(labels.disturbances, "w", study.model.disturbances(),
                                              labels.states, "x", nominal.in_W);
  }
  if (linear.noises() > 0) {
    names["noises"] = names_with_errors(labels.noises, "v", study.model.noises(), labels.outputs,
                                        "y", nominal.in_V);
  }
  return names;
}

/// A pipeline for each backend of the study.
Json pipelines_of(const Json& written, bool has_modes) {
  Json pipelines = Json::array();
  std::set<std::string> names;
  for (const Json& one : written) {
    const Json& backend = one.at("backend");
    const std::string name =
        backend.is_string() ? backend.get<std::string>() : backend.at("type").get<std::string>();
    if (!names.insert(name).second) continue;
    Json made{{"name", name}, {"backend", backend}};
    const Json observer{
        {"type", "prediction_correction"}, {"max_generators", 40}, {"max_constraints", 20}};
    if (has_modes) {
      const bool is_bank = one.contains("diagnoser") && one["diagnoser"].is_object() &&
                           one["diagnoser"].value("type", "") == "consistency_bank";
      made["diagnoser"] = is_bank ? one["diagnoser"] : Json{{"type", "consistency_bank"}};
      made["diagnoser"]["observer"] = observer;
    } else {
      made["observer"] = observer;
    }
    pipelines.push_back(std::move(made));
  }
  return pipelines;
}

}  // namespace

void write_linearised(const Study& study, const std::vector<Linearised>& linear,
                      const std::filesystem::path& file) {
  Json json = Json::parse(*study.source, nullptr, true, true);
  Json formulas = json["system"];
  Json system = system_of(linear.front().model);
  system["names"] = names_of(study, linear.front());
  if (study.labels.sampling_time > 0) system["sampling_time"] = study.labels.sampling_time;
  if (formulas.contains("U")) system["U"] = formulas["U"];
  if (!study.modes.empty()) {
    system["nominal"] = study.nominal;
    for (std::size_t j = 0; j < study.modes.size(); ++j)
      system["modes"].push_back(
          {{"name", study.modes[j].name}, {"system", system_of(linear[j + 1].model)}});
  }
  system["$comment"] = "Linear models that are proven for the states and inputs of the region.";
  json["system"] = std::move(system);
  if (json.contains("data") && json["data"].contains("simulate")) {
    formulas.erase("names");
    formulas.erase("sampling_time");
    json["data"]["simulate"]["plant"] = std::move(formulas);
  }
  json.erase("sweep");
  json["pipelines"] = pipelines_of(json["pipelines"], !study.modes.empty());
  name_data_from(file, study, json);
  write_new_file(file, json_text(json));
}

}  // namespace cordon::apps
