// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include <nlohmann/json.hpp>

#include "cordon/interfaces/nonlinear_model.hpp"
#include "region_json.hpp"
#include "resolve_online.hpp"
#include "resolve_sweep.hpp"
#include "study/reading/read_parts.hpp"
#include "study/text/json_writer.hpp"
#include "study/text/string_sink.hpp"

namespace cordon::json {

namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Vector& x) {
  Json list = Json::array();
  for (const double entry : x) list.push_back(entry);
  return list;
}

Json to_json(const Matrix& A) {
  Json rows = Json::array();
  for (Index i = 0; i < A.rows(); ++i) rows.push_back(to_json(Vector(A.row(i))));
  return rows;
}

/// A matrix, with its radius where it has one.
Json to_json(const Matrix& center, const Matrix& radius) {
  if (radius.size() == 0) return to_json(center);
  return {{"center", to_json(center)}, {"radius", to_json(radius)}};
}

bool is_whole_space(const LineForm& X) {
  return X.constraints() == 0 && X.generators() == 0 && X.lines() == X.dim() && X.M.isIdentity(0) &&
         X.c.isZero(0);
}

/// The simplest type that holds the blocks as they are.
Json to_json(const LineForm& X) {
  const bool lines = X.lines() > 0, constraints = X.constraints() > 0;
  Json set;
  if (lines && is_whole_space(X)) {
    set["type"] = "space";
    set["dim"] = X.dim();
    return set;
  }
  set["type"] = lines                ? "line_zonotope"
                : constraints        ? "constrained_zonotope"
                : X.generators() > 0 ? "zonotope"
                                     : "point";
  set["center"] = to_json(X.c);
  if (lines) set["lines"] = to_json(X.M);
  if (X.generators() > 0) set["generators"] = to_json(X.G);
  if (constraints) {
    if (lines) set["S"] = to_json(X.S);
    if (X.generators() > 0) set["A"] = to_json(X.A);
    set["b"] = to_json(X.b);
  }
  return set;
}

Json to_json(const ComponentSpec& spec, const std::string& kind, const Registry& registry);

struct ToJson {
  const ParamSpec& param;
  const Registry& registry;

  Json operator()(std::int64_t value) const { return value; }
  Json operator()(double value) const { return value; }
  Json operator()(bool value) const { return value; }
  Json operator()(const std::string& value) const { return value; }
  Json operator()(const Vector& value) const { return to_json(value); }
  Json operator()(const Matrix& value) const { return to_json(value); }
  Json operator()(const LineForm& value) const { return to_json(value); }
  Json operator()(const std::vector<Matrix>& value) const {
    Json list = Json::array();
    for (const Matrix& A : value) list.push_back(to_json(A));
    return list;
  }
  Json operator()(const std::shared_ptr<const ComponentSpec>& value) const {
    return to_json(*value, param.component_kind, registry);
  }
};

Json to_json(const ComponentSpec& spec, const std::string& kind, const Registry& registry) {
  Json object;
  object["type"] = spec.type;
  for (const ParamSpec& param : registry.info(kind, spec.type)->schema.specs()) {
    const auto found = spec.params.values().find(param.name);
    if (found != spec.params.values().end())
      object[param.name] = std::visit(ToJson{param, registry}, found->second);
  }
  return object;
}

Json to_json(const Model& model) {
  const LinearModel& linear = model.linear;
  Json system;
  const bool intervals =
      linear.A_radius.size() > 0 || linear.B_radius.size() > 0 || linear.C_radius.size() > 0;
  system["type"] = linear.is_descriptor() ? "descriptor" : intervals ? "interval_lti" : "lti";
  if (linear.is_descriptor()) system["E"] = to_json(linear.E);
  system["A"] = to_json(linear.A, linear.A_radius);
  system["B"] = to_json(linear.B, linear.B_radius);
  system["Bw"] = to_json(linear.Bw);
  system["C"] = to_json(linear.C, linear.C_radius);
  system["D"] = to_json(linear.D);
  system["Dv"] = to_json(linear.Dv);
  if (linear.faults() > 0) system["F"] = to_json(linear.F);
  system["X0"] = to_json(model.X0);
  system["W"] = to_json(model.W);
  system["V"] = to_json(model.V);
  if (model.region) system["region"] = region_json(*model.region);
  return system;
}

void add_formulas(Json& system, const WrittenFormulas& written) {
  const char* lists[] = {"states", "inputs", "disturbances", "noises"};
  for (std::size_t i = 0; i < written.names.size(); ++i) {
    if (!written.names[i].empty()) system[lists[i]] = written.names[i];
  }
  for (const auto& [name, value] : written.parameters) system["parameters"][name] = value;
  for (const ParameterRange& range : written.ranges) {
    Json& parameter = system["parameters"][range.name];
    parameter = {{"lower", range.lower}, {"upper", range.upper}};
    if (range.is_varying) parameter["varying"] = true;
  }
  system["f"] = written.f;
  system["g"] = written.g;
  if (!written.invariants.empty()) system["invariants"] = written.invariants;
}

Json to_json(const Model& model, const WrittenFormulas& written, const Registry& registry) {
  Json system;
  system["type"] = "nonlinear";
  if (written.plant) {
    system["plant"] = to_json(*written.plant, "plant", registry);
  } else {
    add_formulas(system, written);
  }
  const NonlinearModel& formulas = *model.nonlinear;
  const auto set = [&](const char* key, const LineForm& of_model) {
    const auto as_written = written.sets.find(key);
    system[key] = to_json(as_written == written.sets.end() ? of_model : as_written->second);
  };
  if (formulas.admissible) set("admissible", *formulas.admissible);
  if (formulas.undefined == formulas::Undefined::assumed) system["domain"] = "assumed";
  set("X0", model.X0);
  set("W", model.W);
  set("V", model.V);
  return system;
}

/// Effectiveness: a number where it is exact, else a range.
Json to_json(const Box& box) {
  Json list = Json::array();
  for (Index i = 0; i < box.dim(); ++i) {
    list.push_back(box.lower[i] == box.upper[i] ? Json(box.lower[i])
                                                : Json{box.lower[i], box.upper[i]});
  }
  return list;
}

/// Formulas, parameters and sets of a mode, whether or not they are those of the system.
void add_formula_mode(Json& object, const WrittenMode& mode) {
  Json whole;
  add_formulas(whole, *mode.formulas);
  for (const char* key : {"parameters", "f", "g"})
    if (whole.contains(key)) object[key] = whole[key];
  const auto set = [&](const char* key, const LineForm& of_model) {
    const auto as_written = mode.formulas->sets.find(key);
    object[key] = to_json(as_written == mode.formulas->sets.end() ? of_model : as_written->second);
  };
  set("W", mode.system->W);
  set("V", mode.system->V);
}

/// The keys of a mode, without its name.
void add(Json& object, const WrittenMode& mode) {
  if (mode.formulas) return add_formula_mode(object, mode);
  if (mode.actuator) object["actuator"] = to_json(*mode.actuator);
  if (mode.sensor) object["sensor"] = to_json(*mode.sensor);
  if (mode.additive) {
    Json& additive = object["additive"];
    if (mode.additive->F) additive["F"] = to_json(*mode.additive->F);
    if (mode.additive->Fy) additive["Fy"] = to_json(*mode.additive->Fy);
    additive["f"] = to_json(mode.additive->f);
  }
  if (mode.W) object["W"] = to_json(*mode.W);
  if (mode.V) object["V"] = to_json(*mode.V);
  if (mode.system) object["system"] = to_json(*mode.system);
}

/// Names and the time of a step, where they are given.
void add_labels(Json& system, const Labels& labels) {
  if (labels.sampling_time > 0) system["sampling_time"] = labels.sampling_time;
  const std::pair<const char*, const Labels::Names*> all[]{
      {"states", &labels.states},   {"inputs", &labels.inputs},
      {"outputs", &labels.outputs}, {"disturbances", &labels.disturbances},
      {"noises", &labels.noises},   {"faults", &labels.faults}};
  for (const auto& [kind, names] : all) {
    if (!names->empty()) system["names"][kind] = *names;
  }
}

/// U, the name of the nominal mode and the modes, where there are any.
void add_modes(Json& system, const LineForm& U, const std::string& nominal,
               const std::vector<WrittenMode>& modes) {
  if (!is_whole_space(U)) system["U"] = to_json(U);
  if (modes.empty() && nominal == Study{}.nominal) return;
  system["nominal"] = nominal;
  system["modes"] = Json::array();
  for (const WrittenMode& mode : modes) {
    Json object;
    object["name"] = mode.name;
    add(object, mode);
    system["modes"].push_back(std::move(object));
  }
}

Json to_json(const FaultSpec& fault, const WrittenFault& written) {
  Json object;
  object[written.mode.empty() ? "name" : "mode"] = fault.name;
  object["from"] = fault.from;
  if (fault.to != FaultSpec{}.to) object["to"] = fault.to;
  add(object, written.own);
  return object;
}

Json to_json(const Signal& signal) {
  Json object;
  object["type"] = signal_types()[static_cast<std::size_t>(signal.type)];
  for (const std::string& key : signal_keys(signal.type)) {
    if (key == "offset") object[key] = signal.offset;
    if (key == "amplitude") object[key] = signal.amplitude;
    if (key == "omega") object[key] = signal.omega;
    if (key == "phase") object[key] = signal.phase;
    if (key == "from") object[key] = signal.from;
    if (key == "period") object[key] = signal.period;
    if (key == "seed") object[key] = signal.seed;
    if (key == "values") object[key] = to_json(signal.values);
  }
  return object;
}

Json to_json(const AdditiveFaultSpec& fault) {
  Json object;
  object["fault"] = fault.fault + 1;
  object["from"] = fault.from;
  if (fault.to != AdditiveFaultSpec{}.to) object["to"] = fault.to;
  object["signal"] = to_json(fault.signal);
  return object;
}

Json to_json(const DropoutSpec& dropout) {
  Json object;
  object["outputs"] = Json::array();
  for (const Index output : dropout.outputs) object["outputs"].push_back(output + 1);
  object["from"] = dropout.from;
  if (dropout.to != DropoutSpec{}.to) object["to"] = dropout.to;
  object["probability"] = dropout.probability;
  if (dropout.every > 0) object["every"] = dropout.every;
  return object;
}

/// What pipelines without a designer need is left out where all have one: `streamed` is false.
Json to_json(const SimulateSpec& spec, const LinearModel& model, bool streamed,
             const Written& written, const Registry& registry) {
  Json object;
  if (streamed) object["steps"] = spec.steps;
  object["seed"] = spec.seed;
  if (spec.seeds != 1) object["seeds"] = spec.seeds;
  object["noise"] = noise_names()[static_cast<std::size_t>(spec.noise)];
  if (spec.x0) object["x0"] = to_json(*spec.x0);
  if (spec.x0_set) object["x0"] = to_json(*spec.x0_set);
  if (!streamed) return object;
  if (spec.parameters != ParameterDraw::constant ||
      (model.is_uncertain() && !spec.plant && !spec.formulas))
    object["parameters"] = parameter_draw_names()[static_cast<std::size_t>(spec.parameters)];
  object["input"] = Json::array();
  for (const Signal& signal : spec.input) object["input"].push_back(to_json(signal));
  if (spec.plant) object["plant"] = to_json(*spec.plant, "plant", registry);
  if (spec.formulas) {
    const SystemPart& plant = *written.plant;
    object["plant"] = to_json(plant.model, *plant.formulas, registry);
    add_modes(object["plant"], plant.model.U, plant.nominal, plant.written);
  }
  for (std::size_t i = 0; i < spec.faults.size(); ++i)
    object["faults"].push_back(to_json(spec.faults[i], written.faults[i]));
  for (const AdditiveFaultSpec& fault : spec.additive_faults)
    object["additive_faults"].push_back(to_json(fault));
  for (const DropoutSpec& dropout : spec.dropouts) object["dropouts"].push_back(to_json(dropout));
  for (const OutlierSpec& outlier : spec.outliers) {
    object["outliers"].push_back(to_json(outlier.when));
    object["outliers"].back()["shift"] = outlier.shift;
  }
  return object;
}

Json to_json(const CsvSpec& spec, const std::string& written_file) {
  Json object;
  object["file"] = written_file;
  object["inputs"] = spec.inputs;
  object["outputs"] = spec.outputs;
  if (!spec.truth.empty()) object["truth"] = spec.truth;
  if (!spec.mode.empty()) object["mode"] = spec.mode;
  if (spec.missing != MissingValue::error)
    object["missing"] = missing_value_names()[static_cast<std::size_t>(spec.missing)];
  if (!spec.time.empty()) object["time"] = spec.time;
  if (spec.irregular != IrregularRows::error)
    object["irregular"] = irregular_rows_names()[static_cast<std::size_t>(spec.irregular)];
  return object;
}

void add_options(Json& pipeline, const EstimationSpec& spec) {
  if (spec.on_empty != OnEmpty::stop) {
    pipeline["on_empty"] = on_empty_names()[static_cast<std::size_t>(spec.on_empty)];
    pipeline["restart_set"] = to_json(spec.restart_set);
  }
  if (spec.on_not_enclosed != OnNotEnclosed::stop) {
    pipeline["on_not_enclosed"] =
        on_not_enclosed_names()[static_cast<std::size_t>(spec.on_not_enclosed)];
  }
  if (spec.outliers > 0)
    pipeline["outliers"] = {{"most", spec.outliers}, {"in", spec.outlier_window}};
}

/// Like dump(2), but a list of plain values stays on one line: a matrix takes a line per row.
void print(const Json& value, detail::JsonWriter& json) {
  const bool flat = value.is_array() && std::none_of(value.begin(), value.end(), [](const Json& v) {
                      return v.is_structured();
                    });
  if (!value.is_structured() || value.empty() || flat) {
    json.raw(value.dump());
    return;
  }
  using detail::JsonWriter;
  value.is_array() ? json.begin_array(JsonWriter::Layout::lines)
                   : json.begin_object(JsonWriter::Layout::lines);
  for (const auto& [key, member] : value.items()) {
    if (value.is_object()) json.key(key);
    print(member, json);
  }
  value.is_array() ? json.end_array() : json.end_object();
}

}  // namespace

std::string resolve(const Study& study, const Written& written,
                    const std::vector<WrittenAxis>& sweep, const Registry& registry) {
  Json root;
  root["cordon"] = 1;
  root["title"] = study.title;
  if (!written.plugins.empty()) root["plugins"] = written.plugins;
  root["system"] =
      written.formulas ? to_json(study.model, *written.formulas, registry) : to_json(study.model);
  add_labels(root["system"], study.labels);
  add_modes(root["system"], study.model.U, study.nominal, written.modes);
  const bool streamed = std::any_of(study.pipelines.begin(), study.pipelines.end(),
                                    [](const PipelineSpec& p) { return !p.design(); });
  if (const auto* simulate = std::get_if<SimulateSpec>(&study.data)) {
    if (study.has_data || !streamed)
      root["data"]["simulate"] =
          to_json(*simulate, study.model.linear, streamed, written, registry);
  } else {
    root["data"]["csv"] = to_json(std::get<CsvSpec>(study.data), written.csv_file);
  }
  root["pipelines"] = Json::array();
  for (const PipelineSpec& spec : study.pipelines) {
    Json pipeline;
    pipeline["name"] = spec.name;
    pipeline["backend"] = to_json(spec.backend, "backend", registry);
    for (const auto& [kind, component] : algorithms_of(spec))
      pipeline[kind] = to_json(*component, kind, registry);
    if (const EstimationSpec* const estimation = spec.estimation())
      add_options(pipeline, *estimation);
    if (spec.max_programs) pipeline["max_programs"] = *spec.max_programs;
    root["pipelines"].push_back(std::move(pipeline));
  }
  root["metrics"] = Json::array();
  for (const ComponentSpec& spec : study.metrics)
    root["metrics"].push_back(to_json(spec, "metric", registry));
  if (const Json online = resolved_online(study.online); online != resolved_online({}))
    root["online"] = online;
  if (!sweep.empty()) add_sweep(root, written.tree, sweep);
  detail::StringSink text;
  detail::JsonWriter json(text);
  print(root, json);
  return text.text + "\n";
}

}  // namespace cordon::json
