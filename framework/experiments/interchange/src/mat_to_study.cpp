// SPDX-License-Identifier: GPL-3.0-or-later
// A MAT-file as the beginning of a study.
#include <algorithm>
#include <set>

#include "cordon/solvers/set_questions.hpp"
#include "experiments/interchange/mat_file.hpp"
#include "experiments/interchange/model_to_mat.hpp"
#include "mat_to_data.hpp"
#include "mat_to_system.hpp"
#include "study/reading/read_parts.hpp"
#include "study/reading/read_sets.hpp"
#include "study/text/json_cursor.hpp"
#include "write_files.hpp"

namespace cordon {

namespace {

namespace fs = std::filesystem;
using json::Json;
using mat::Value;
using mat::Variable;
using mat::Variables;

[[noreturn]] void refuse(const fs::path& file, const std::string& place, const std::string& message,
                         const std::string& suggestion) {
  throw InputError(file.string(), {{place, message, suggestion}});
}

const Value* find(const Variables& all, const std::string& name) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Variable& v) { return v.name == name; });
  return found == all.end() ? nullptr : &found->value;
}

std::vector<std::string> names_of(const Variables& all, bool (*is)(const Value&)) {
  std::vector<std::string> names;
  for (const Variable& v : all) {
    if (is(v.value)) names.push_back(v.name);
  }
  return names;
}

bool is_set_or_sets(const Value& value) {
  if (!value.is(Value::Kind::cell)) return mat::is_set(value);
  return !value.items.empty() && std::all_of(value.items.begin(), value.items.end(), mat::is_set);
}

/// All variables as the fields of one struct.
Value as_struct(const Variables& all) {
  mat::Struct fields;
  for (const Variable& v : all) fields.set(v.name, v.value);
  return std::move(fields).value();
}

void refuse_twins(const Variables& all, const fs::path& file) {
  std::set<std::string> names;
  for (const Variable& v : all) {
    if (!names.insert(v.name).second)
      refuse(file, json::child("", v.name), "stands there twice", "save it again, once");
  }
}

/// Variables that would be the system if there were no struct that is one, for a warning; "" if
/// there are none.
std::string other_system(const Variables& all) {
  std::string names;
  if (!find(all, "A") || !find(all, "C")) return names;
  for (const char* name :
       {"E", "A", "B", "Bw", "C", "D", "Dv", "F", "X0", "W", "V", "U", "modes"}) {
    if (find(all, name)) names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return "the variables " + names + " (the system is taken from a struct beside them)";
}

/// Variables that are there and cannot be used, for messages.
std::string refusals(const Variables& all) {
  std::string text;
  for (const Variable& v : all) {
    if (v.value.is(Value::Kind::refused))
      text += "; " + json::in_quotes(v.name) + " cannot be used: " + v.value.text;
  }
  return text;
}

struct Choice {
  Value value;
  bool system = false;     ///< otherwise a set, or sets
  bool workspace = false;  ///< the matrices are variables of their own
};

Choice choose(const Variables& all, const fs::path& file, const std::string& variable) {
  if (!variable.empty()) {
    const Value* value = find(all, variable);
    std::vector<std::string> names;
    for (const Variable& v : all) names.push_back(v.name);
    if (!value)
      refuse(file, "", "holds no variable " + json::in_quotes(variable), suggest(variable, names));
    if (mat::is_system(*value)) return {*value, true};
    if (is_set_or_sets(*value)) return {*value};
    refuse(file, json::child("", variable),
           value->is(Value::Kind::refused) ? mat::kind_of(*value)
                                           : mat::kind_of(*value) + ", neither a system nor sets",
           "a system is a struct with A and C");
  }
  if (const Value* system = find(all, "system"); system && mat::is_system(*system))
    return {*system, true};
  if (find(all, "A") && find(all, "C")) return {as_struct(all), true, true};
  for (bool system : {true, false}) {
    const std::vector<std::string> names = names_of(all, system ? mat::is_system : is_set_or_sets);
    if (names.size() == 1) return {*find(all, names[0]), system};
    if (names.size() > 1) {
      refuse(file, "",
             std::string("holds more than one ") + (system ? "system" : "variable with sets"),
             "choose one with --variable: " + suggest("", names));
    }
  }
  refuse(file, "", "holds no system and no sets" + refusals(all),
         "a system is a struct with matrices A and C, or variables of these names; a set is a "
         "struct with lower and upper, or c "
         "and G");
}

Json sets_json(const Value& sets, json::Problems& problems) {
  if (sets.is(Value::Kind::structs) && sets.rows * sets.cols == 1)
    return mat::set_of(sets, 0, "", problems);
  Json list = Json::array();
  const Index count = sets.rows * sets.cols;
  for (Index i = 0; i < count; ++i) {
    const std::string place = json::child("", static_cast<std::size_t>(i));
    const bool cell = sets.is(Value::Kind::cell);
    list.push_back(cell ? mat::set_of(sets.items[static_cast<std::size_t>(i)], 0, place, problems)
                        : mat::set_of(sets, i, place, problems));
  }
  return list;
}

/// Lines of a text that nobody has seen say nothing.
[[noreturn]] void fail(const fs::path& file, const json::Problems& problems) {
  std::vector<Diagnostic> found = problems.sorted();
  for (Diagnostic& one : found) one.line = 0;
  throw InputError(file.string(), std::move(found));
}

/// What W and V are, as far as the sizes go, until somebody says it.
Json with_placeholders(Json system, std::vector<std::string>& missing) {
  const std::pair<const char*, const char*> sets[] = {{"W", "Bw"}, {"V", "Dv"}};
  for (const auto& [set, matrix] : sets) {
    if (system.contains(set)) continue;
    const char* fallback = set[0] == 'W' ? "A" : "C";
    Json rows = system.contains(matrix) ? system[matrix] : system[fallback];
    if (rows.is_object()) rows = rows["center"];
    std::size_t dim = rows.size();
    if (system.contains(matrix)) dim = rows.empty() ? 0 : rows[0].size();
    if (dim > 0) missing.emplace_back(set);
    system[set] = {{"type", "point"}, {"center", Json(std::vector<int>(dim, 0))}};
  }
  return system;
}

/// The system as the reader of studies takes it.
json::SystemPart checked(const Json& system, const fs::path& file) {
  json::Problems problems;
  const json::Value tree = json::parse(system.dump(), problems);
  std::vector<std::string> warnings;
  json::SystemPart part = json::read_recorded_system(json::Cursor(tree, "", problems), warnings);
  if (problems.any()) fail(file, problems);
  return part;
}

Json pipelines_for(const json::SystemPart& system) {
  const LinearModel& m = system.model.linear;
  Json observer{{"type", m.is_descriptor() ? "descriptor" : "prediction_correction"},
                {"max_generators", 40}};
  if (m.is_uncertain() && !m.is_descriptor())
    observer = {{"type", "zonotope_uncertain"}, {"gain", {{"type", "h_infinity"}}}};
  const bool bounded = is_bounded(system.model.X0) == Answer::yes;
  Json list = Json::array();
  // of a descriptor system, a zonotope needs [E; C] of full column rank
  if (bounded && !m.is_descriptor())
    list.push_back({{"name", "Zonotope"}, {"backend", "zonotope"}, {"observer", observer}});
  if (!bounded || m.is_descriptor() || !m.is_uncertain()) {
    list.push_back(
        {{"name", "Line zonotope"}, {"backend", "line_zonotope"}, {"observer", observer}});
  }
  return list;
}

Json simulated(const LinearModel& m) {
  Json simulate{{"steps", 50}, {"seed", 1}};
  if (m.inputs() > 0) {
    simulate["input"] = Json::array();
    for (Index i = 0; i < m.inputs(); ++i)
      simulate["input"].push_back({{"type", "constant"}, {"offset", 0}});
  }
  return {{"simulate", std::move(simulate)}};
}

Json recorded(const CsvSpec& spec, const fs::path& file) {
  Json csv{{"file", file.filename().string()}};
  if (!spec.inputs.empty()) csv["inputs"] = spec.inputs;
  csv["outputs"] = spec.outputs;
  if (!spec.truth.empty()) csv["truth"] = spec.truth;
  if (!spec.mode.empty()) csv["mode"] = spec.mode;
  if (spec.missing == MissingValue::skip) csv["missing"] = "skip";
  return {{"csv", std::move(csv)}};
}

std::string title_of(const Variables& all, const fs::path& file) {
  const Value* about = find(all, "cordon");
  const Value* title = about ? about->field("title") : nullptr;
  std::string text = title && title->is(Value::Kind::text) && !title->text.empty()
                         ? title->text
                         : file.stem().string();
  const auto control = [](unsigned char c) { return c < 0x20 || c == 0x7F; };
  std::replace_if(text.begin(), text.end(), control, ' ');
  return text;
}

std::string comment_for(const fs::path& file, const std::vector<std::string>& missing) {
  std::string text = "Made from " + file.filename().string() +
                     ". Data and pipelines are a beginning: change them at will.";
  for (const std::string& set : missing) {
    text += set == "W" ? " Add \"W\" to the system, a set that contains every disturbance w (one "
                         "coordinate per column of Bw)."
                       : " Add \"V\" to the system, a set that contains every measurement noise v "
                         "(one coordinate per column of Dv).";
  }
  return text;
}

}  // namespace

ImportedStudy mat_to_json(const fs::path& file, const Target& target, const std::string& variable) {
  const Variables all = mat::read_file(file);
  refuse_twins(all, file);
  const Choice choice = choose(all, file, variable);
  ImportedStudy imported;
  json::Problems problems;
  if (!choice.system) {
    const Json sets = sets_json(choice.value, problems);
    if (problems.any()) fail(file, problems);
    imported.sets_only = true;
    imported.files = {target.file};
    detail::write_files({{target.file, json::pretty(sets)}}, target.replace);
    return imported;
  }
  const Json system = mat::system_of(choice.value, imported.ignored, problems);
  if (choice.workspace) imported.ignored.clear();
  const std::string others = choice.workspace || !variable.empty() ? "" : other_system(all);
  if (!others.empty()) imported.ignored.push_back(others);
  if (problems.any()) fail(file, problems);
  const json::SystemPart part = checked(with_placeholders(system, imported.missing), file);
  const Value* data = find(all, "data");
  const bool in_struct = data && data->field("y");
  const auto csv =
      mat::data_of(in_struct ? *data : as_struct(all), part, in_struct ? "/data" : "", problems);
  if (problems.any()) fail(file, problems);
  fs::path table = target.file;
  table.replace_extension(".csv");
  Json study;
  study["$comment"] = comment_for(file, imported.missing);
  study["cordon"] = 1;
  study["title"] = title_of(all, file);
  study["system"] = system;
  study["data"] = csv ? recorded(csv->spec, table) : simulated(part.model.linear);
  study["pipelines"] = pipelines_for(part);
  study["metrics"] = csv && csv->spec.truth.empty() ? Json{"radius", "step_time"}
                                                    : Json{"radius", "contains_truth", "step_time"};
  std::vector<std::pair<fs::path, std::string>> files;
  if (csv) files.emplace_back(table, csv->text);
  files.emplace_back(target.file, json::pretty(study));
  for (const auto& [path, content] : files) imported.files.push_back(path);
  detail::write_files(files, target.replace);
  return imported;
}

void sets_to_mat(const fs::path& file, const Target& target) {
  json::Problems problems;
  const json::Value tree = json::parse(json::read_file(file.string()), problems);
  const json::Cursor root(tree, "", problems);
  std::vector<std::string> warnings;
  std::vector<Value> sets;
  const auto add = [&](const json::Cursor& at) {
    if (const auto set = json::read_set(at, warnings)) sets.push_back(mat::to_mat(*set));
  };
  const bool list = root.is(json::Value::Kind::array);
  for (std::size_t i = 0; list && i < root.size(); ++i) add(root.item(i));
  if (!list) add(root);
  if (problems.any()) throw InputError(file.string(), problems.sorted());
  Variables all{{"cordon", mat::about("sets", file.stem().string())}};
  all.push_back(list ? Variable{"sets", mat::cell(std::move(sets))}
                     : Variable{"set", std::move(sets.front())});
  detail::write_files({{target.file, mat::to_bytes(all)}}, target.replace);
}

}  // namespace cordon
