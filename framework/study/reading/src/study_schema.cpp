// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>

#include "schema_parts.hpp"
#include "study/reading/read_parts.hpp"
#include "study/reading/read_sets.hpp"

namespace cordon {

namespace {

using namespace schema_parts;

Json sets() {
  const Json vector = reference("vector"), matrix = reference("matrix"),
             bounds = reference("bounds"), number{{"type", "number"}};
  Json all = Json::array();
  all.push_back(described(typed("box", {{"lower", bounds}, {"upper", bounds}}, {"lower", "upper"}),
                          "{x : lower ≤ x ≤ upper}; a coordinate is bounded or free"));
  all.push_back(
      described(typed("zonotope", {{"center", vector}, {"generators", matrix}}, {"center"}),
                "{c + Gξ : ‖ξ‖∞ ≤ 1}; one generator per column"));
  all.push_back(described(
      typed("constrained_zonotope",
            {{"center", vector}, {"generators", matrix}, {"A", matrix}, {"b", vector}}, {"center"}),
      "{c + Gξ : ‖ξ‖∞ ≤ 1, Aξ = b}"));
  all.push_back(described(typed("line_zonotope",
                                {{"center", vector},
                                 {"lines", matrix},
                                 {"generators", matrix},
                                 {"S", matrix},
                                 {"A", matrix},
                                 {"b", vector}},
                                {"center"}),
                          "{c + Mδ + Gξ : ‖ξ‖∞ ≤ 1, Sδ + Aξ = b}; M holds the lines"));
  all.push_back(described(
      typed("strip",
            {{"rho", vector}, {"d", number}, {"sigma", {{"type", "number"}, {"minimum", 0}}}},
            {"rho", "d", "sigma"}),
      "{x : |rhoᵀx - d| ≤ sigma}"));
  all.push_back(described(typed("space", {{"dim", integer(0, json::max_dimension)}}, {"dim"}),
                          "the whole space"));
  all.push_back(described(typed("point", {{"center", vector}}, {"center"}), "a single point"));
  Json polytope = typed(
      "polytope", {{"lower", vector}, {"upper", vector}, {"H", matrix}, {"h", vector}}, {"H", "h"});
  polytope["dependentRequired"] = {{"lower", {"upper"}}, {"upper", {"lower"}}};
  all.push_back(described(
      polytope, "{x : lower ≤ x ≤ upper, H x ≤ h}; without bounds they are found exactly"));
  all.push_back(described(typed("polytope", {{"vertices", matrix}}, {"vertices"}),
                          "convex hull; one vertex per row"));
  return {{"oneOf", all}};
}

Json signals() {
  const Json properties{
      {"amplitude", {{"type", "number"}}},
      {"omega", described({{"type", "number"}}, "radians per step")},
      {"phase", described({{"type", "number"}, {"default", 0}}, "radians")},
      {"offset", {{"type", "number"}}},
      {"from", integer(0, static_cast<std::int64_t>(json::max_integer))},
      {"period", integer(1, static_cast<std::int64_t>(json::max_integer))},
      {"seed", integer(0, static_cast<std::int64_t>(json::max_integer))},
      {"values", {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 1}}}};
  Json all = Json::array();
  for (std::size_t i = 0; i < json::signal_types().size(); ++i) {
    const auto type = static_cast<Signal::Type>(i);
    const std::vector<std::string> keys = json::signal_keys(type);
    Json own = Json::object();
    for (const std::string& key : keys) own[key] = properties[key];
    const auto required = static_cast<std::ptrdiff_t>(json::required_signal_keys(type));
    all.push_back(typed(json::signal_types()[i], own, {keys.begin(), keys.begin() + required}));
  }
  return {{"oneOf", all}};
}

Json sparse_matrix() {
  const Json size = integer(0, json::max_entries), place = integer(1, json::max_entries);
  const Json entry{{"type", "array"},
                   {"prefixItems", {place, place, {{"type", "number"}}}},
                   {"minItems", 3},
                   {"maxItems", 3}};
  return described(object({{"rows", size},
                           {"cols", size},
                           {"entries", described(list_of(entry), "[row, column, number]")}},
                          {"rows", "cols", "entries"}),
                   "sparse: the entries that are not 0, rows and columns counted from 1");
}

Json interval_matrix() {
  const Json matrix = reference("matrix");
  return {{"anyOf",
           {matrix,
            object({{"center", matrix}, {"radius", described(matrix, "at least 0")}},
                   {"center", "radius"}),
            object({{"lower", matrix}, {"upper", matrix}}, {"lower", "upper"})}}};
}

/// The matrices and sets of a model, without "type" and E; A, B and C are exact or `general`.
Json model_properties(const std::string& general) {
  const Json matrix = reference("matrix"), set = reference("set"), interval = reference(general);
  Json properties;
  properties["A"] = described(interval, "n × n");
  properties["B"] = described(interval, "n × inputs; absent: no inputs");
  properties["Bw"] = described(matrix, "n × disturbances; the identity by default");
  properties["C"] = described(interval, "outputs × n");
  properties["D"] = described(matrix, "outputs × inputs; zero by default");
  properties["Dv"] = described(matrix, "outputs × noises; the identity by default");
  properties["X0"] = described(
      set, "contains the initial state; the whole space by default, in a mode the nominal one");
  properties["W"] =
      described(set, "contains every disturbance w; may be absent only if Bw has no columns");
  properties["V"] =
      described(set, "contains every measurement noise v; may be absent only if Dv has no columns");
  return properties;
}

/// The keys of systems that can be sampled.
Json continuous_properties() {
  Json continuous{{"type", "boolean"}, {"default", false}};
  Json disturbance = one_of(json::disturbance_signal_names());
  disturbance["default"] = json::disturbance_signal_names().front();
  return {{"continuous", described(continuous,
                                   "the model is ẋ = A x + B u + Bw w, in the unit of time of "
                                   "sampling_time, and is sampled")},
          {"disturbance", described(disturbance,
                                    "w of a continuous model between samples: any signal with "
                                    "values in W, or constant")}};
}

Json region() {
  const Json bounds =
      object({{"lower", reference("bounds")}, {"upper", reference("bounds")}}, {"lower", "upper"});
  return described(
      object(
          {{"states", bounds},
           {"inputs", bounds},
           {"nonlinear_outputs",
            described({{"type", "boolean"}}, "the equation of the outputs holds there only, too")}},
          {"states"}),
      "states and inputs for which the linear model is proven; everywhere by default");
}

/// `more`: other keys; none: of a mode.
Json systems(const Json& more) {
  Json exact = model_properties("matrix"), general = model_properties("interval_matrix");
  exact.update(more);
  general.update(more);
  if (!more.empty()) exact.update(continuous_properties());
  exact["region"] = region();
  Json intervals = general;
  if (!more.empty()) intervals.update(continuous_properties());
  const Json lti = typed("lti", exact, {"A", "C"}),
             interval_lti = typed("interval_lti", intervals, {"A", "C"});
  general["E"] = described(reference("matrix"), "n × n, may be singular");
  const Json descriptor = typed("descriptor", general, {"E", "A", "C"});
  return {{"oneOf",
           {described(lti, "x⁺ = A x + B u + Bw w, y = C x + D u + Dv v"),
            described(interval_lti, "the same with A, B and C known by intervals"),
            described(descriptor, "E x⁺ = A x + B u + Bw w, y = C x + D u + Dv v")}}};
}

Json effectiveness() {
  const Json share{{"type", "number"}, {"minimum", 0}, {"maximum", 1}};
  const Json range{{"type", "array"}, {"items", share}, {"minItems", 2}, {"maxItems", 2}};
  return described(list_of({{"anyOf", {share, range}}}),
                   "0: outage, 1: health; a number, or a range [low, high]");
}

/// What is different in a mode or a fault.
Json mode_properties() {
  const Json set = reference("set");
  Json additive = object({{"F", described(reference("matrix"), "n × values of f")},
                          {"Fy", described(reference("matrix"), "outputs × values of f")},
                          {"f", described(set, "contains f at every step")}},
                         {"f"});
  additive["anyOf"] = {{{"required", {"F"}}}, {{"required", {"Fy"}}}};
  Json properties;
  properties["actuator"] = described(reference("effectiveness"), "one entry per column of B");
  properties["sensor"] = described(reference("effectiveness"), "one entry per row of C");
  properties["additive"] =
      described(additive, "F f is added to the state's equation, Fy f to the outputs");
  properties["W"] = described(set, "in place of the system's W");
  properties["V"] = described(set, "in place of the system's V");
  properties["system"] =
      described(reference("mode_system"), "another model; in place of additive, W and V");
  return properties;
}

Json modes() {
  Json properties{{"name", text(200)}};
  properties.update(mode_properties());
  return object(properties, {"name"});
}

Json faults() {
  const Json time = integer(0, static_cast<std::int64_t>(json::max_integer));
  Json times;
  times["from"] = described(time, "the first k whose y_k and x_{k+1} are made with the fault");
  times["from"]["default"] = 0;
  times["to"] = described(time, "the last such k; the end by default");
  Json inside{{"mode", described(text(200), "name of a mode")}};
  inside.update(times);
  for (const char* key : {"actuator", "sensor"})
    inside[key] =
        described(reference("effectiveness"), "inside the range of the mode; its range by default");
  Json outside{{"name", described(text(200), "for people")}};
  outside.update(times);
  outside.update(mode_properties());
  return {{"oneOf",
           {described(object(inside, {"mode"}), "a mode of the bank"),
            described(object(outside, {}), "a fault outside the bank")}}};
}

Json definitions(const Registry& registry) {
  Json defs;
  defs["vector"] = list_of({{"type", "number"}});
  defs["matrix"] = {{"anyOf",
                     {described(list_of(reference("vector")), "a list of rows of equal length"),
                      sparse_matrix()}}};
  defs["interval_matrix"] = interval_matrix();
  defs["bounds"] = list_of({{"anyOf", {{{"type", "number"}}, one_of({"inf", "-inf"})}}});
  defs["set"] = sets();
  defs["signal"] = signals();
  const Json names = list_of(text(60));
  Json kinds;
  for (const char* kind : {"states", "inputs", "outputs", "disturbances", "noises", "faults"})
    kinds[kind] = names;
  const Json system_names = described(
      object(kinds, {}), "for people: one name each, with the unit in brackets, \"level [m]\"");
  const Json sampling_time = described(Json{{"type", "number"}, {"exclusiveMinimum", 0}},
                                       "seconds from k to k + 1; a continuous model needs it");
  defs["system"] = systems(
      {{"names", system_names},
       {"sampling_time", sampling_time},
       {"F",
        described(reference("matrix"), "n × faults: directions of additive faults, a column each")},
       {"U", described(reference("set"), "contains every input u; the whole space by default")},
       {"nominal", described(text(200), "name of the nominal mode; \"healthy\" by default")},
       {"modes",
        described(Json{{"type", "array"}, {"items", reference("mode")}, {"maxItems", 1000}},
                  "the faults that diagnosers tell apart")}});
  for (const Json& system : nonlinear_systems(system_names, sampling_time)) {
    defs["system"]["oneOf"].push_back(system);
    defs["nonlinear_system"]["oneOf"].push_back(system);
  }
  defs["mode_system"] = systems(Json::object());
  defs["effectiveness"] = effectiveness();
  defs["mode"] = modes();
  defs["fault"] = faults();
  defs["data"] = data();
  for (const std::string& kind : Registry::kinds()) defs[kind] = components(registry, kind);
  Json on_empty = described(one_of(json::on_empty_names()),
                            "after an estimate that is proven empty: it stays empty, or the "
                            "observer begins anew with the next sample");
  on_empty["default"] = "stop";
  Json on_not_enclosed = described(
      one_of(json::on_not_enclosed_names()),
      "where values of formulas over an estimate have no bounded enclosure: the pipeline ends, or "
      "the observer begins anew from the system's admissible set, with this sample");
  on_not_enclosed["default"] = "stop";
  const Json count = integer(1, static_cast<std::int64_t>(json::max_integer));
  const Json outliers =
      described(object({{"most", described(count, "samples of which outputs may be left out")},
                        {"in", described(count, "so many samples that follow each other")}},
                       {"most", "in"}),
                "outputs that miss the prediction are left out");
  Json pipeline = object(
      {{"name", described(text(200), "unique; the backend's name by default")},
       {"backend", reference("backend")},
       {"observer", reference("observer")},
       {"on_empty", on_empty},
       {"restart_set", described(reference("set"),
                                 "holds the state where the "
                                 "observer begins anew; the whole space by "
                                 "default")},
       {"on_not_enclosed", on_not_enclosed},
       {"outliers", outliers},
       {"max_programs", described(integer(0, static_cast<std::int64_t>(json::max_integer)),
                                  "programs that a step begins at most, and each mode of a "
                                  "bank; what is left open is unknown; no limit by default")},
       {"diagnoser", reference("diagnoser")},
       {"designer", reference("designer")}},
      {"backend"});
  const Json bank_wide{{"anyOf", {{{"required", {"diagnoser"}}}, {{"required", {"designer"}}}}}};
  pipeline["oneOf"] = {{{"required", {"observer"}}}, bank_wide};
  defs["pipeline"] = pipeline;
  return defs;
}

Json sweep() {
  const Json whole = integer(-static_cast<std::int64_t>(json::max_integer),
                             static_cast<std::int64_t>(json::max_integer));
  Json properties;
  properties["name"] = described(text(200), "unique; the name of its column in tables");
  const Json one_path{{"type", "string"}, {"pattern", "^(/([^~]|~[01])*)+$"}, {"maxLength", 4096}};
  const Json paths{{"type", "array"}, {"items", one_path}, {"minItems", 1}, {"maxItems", 100}};
  properties["path"] = described(
      Json{{"anyOf", {one_path, paths}}},
      "what is varied: a JSON pointer, with \"*\" for every element of a list: "
      "/pipelines/*/observer/max_generators; or a list of them, whose values go together");
  properties["scale"] = described(
      one_path, "in place of path: one place, whose number, matrix or set is scaled by the values");
  properties["values"] = described(
      Json{{"type", "array"}, {"minItems", 1}, {"maxItems", 100'000}, {"uniqueItems", true}},
      "they take the place of what stands there, one after another");
  properties["labels"] =
      described(Json{{"type", "array"}, {"items", text(200)}, {"uniqueItems", true}},
                "what the values are called in tables and figures, one per value");
  properties["range"] =
      described(Json{{"type", "array"}, {"items", whole}, {"minItems", 2}, {"maxItems", 3}},
                "[first, last] or [first, last, step]: integers, in place of values");
  properties["repeat"] = described(
      Json{{"type", "boolean"}},
      "statistics are taken over these values; by default true where the path ends in /seed");
  Json axis = object(properties, {"name"});
  const Json one_way{{"oneOf", {{{"required", {"path"}}}, {{"required", {"scale"}}}}}},
      one_list{{"oneOf", {{{"required", {"values"}}}, {{"required", {"range"}}}}}};
  axis["allOf"] = {one_way, one_list};
  return {{"type", "array"}, {"items", axis}, {"minItems", 1}, {"maxItems", 100}};
}

Json online() {
  Json properties;
  properties["jumps"] = described(one_of(json::jump_rule_names()),
                                  "times that are left out: refused, or taken without outputs");
  properties["longest_gap"] =
      described(Json{{"type", "integer"}, {"minimum", 1}, {"default", 1000}},
                "times that are filled at most");
  properties["late"] = described(one_of(json::late_rule_names()),
                                 "outputs of times that have passed: left out, or the past is "
                                 "taken again with them");
  properties["lag"] =
      described(Json{{"type", "integer"}, {"minimum", 1}, {"maximum", 10'000}, {"default", 10}},
                "samples that late outputs may lie behind the last one");
  properties["repeated"] = described(one_of(json::repeat_rule_names()),
                                     "a sample that brings nothing new: an error, or left out");
  properties["clock_tolerance"] = described(
      Json{{"type", "number"}, {"minimum", 0}, {"exclusiveMaximum", 0.5}, {"default", 0.01}},
      "what the time \"t\" of a sample may miss the plant's by, of a sampling time");
  properties["clock_drift"] = described(
      Json{{"type", "number"}, {"minimum", 0}, {"exclusiveMaximum", 0.5}, {"default", 0.001}},
      "share by which the plant's clock may run fast or slow");
  return object(properties, {});
}

Json with_simulate(Json properties, const std::vector<std::string>& required) {
  Json simulate{{"properties", std::move(properties)}};
  if (!required.empty()) simulate["required"] = required;
  return {{"properties", {{"data", {{"properties", {{"simulate", simulate}}}}}}}};
}

/// Data are for pipelines without a designer; beside one with a designer they are not recorded.
Json conditions() {
  const Json designer{{"required", {"designer"}}};
  Json all_designed{{"properties", {{"pipelines", {{"items", designer}}}}}};
  Json refused;
  for (const char* key : {"steps", "input", "parameters", "plant", "faults", "additive_faults",
                          "dropouts", "outliers"})
    refused[key] = false;
  Json streamed = with_simulate(Json::object(), {"steps"});
  streamed["anyOf"] = {{{"required", {"data"}}}, {{"required", {"online"}}}};
  Json one_designed{{"properties", {{"pipelines", {{"contains", designer}}}}}};
  Json simulated{{"properties", {{"data", {{"properties", {{"csv", false}}}}}}}};
  return {{{"if", all_designed}, {"then", with_simulate(refused, {})}, {"else", streamed}},
          {{"if", one_designed}, {"then", simulated}}};
}

}  // namespace

std::string study_json_schema(const Registry& registry) {
  Json properties;
  properties["cordon"] = described({{"const", 1}}, "version of the format");
  properties["title"] = text(1000);
  properties["plugins"] =
      described({{"type", "array"}, {"items", text(4096)}, {"uniqueItems", true}},
                "directories of plugins, relative to the folder of the study");
  properties["system"] = reference("system");
  properties["data"] = reference("data");
  properties["pipelines"] = {
      {"type", "array"}, {"items", reference("pipeline")}, {"minItems", 1}, {"maxItems", 1000}};
  properties["metrics"] = list_of(reference("metric"));
  properties["online"] =
      described(online(), "what becomes of samples out of order (cordon stream)");
  properties["sweep"] = described(sweep(), "the study is run under all combinations of the values");
  Json root{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Cordon study"}};
  root.update(object(properties, {"cordon", "system", "pipelines"}));
  root["allOf"] = conditions();
  root["$defs"] = definitions(registry);
  return root.dump(2) + "\n";
}

}  // namespace cordon
