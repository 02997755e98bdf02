// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>

#include "study/reading/read_parts.hpp"
#include "study/reading/read_sets.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;
constexpr std::size_t max_text = 65536;
constexpr std::size_t max_pipelines = 1000;
constexpr int max_nesting = 8;  // of components

const char* article(std::string_view kind) { return kind == "observer" ? "an " : "a "; }

/// A list of rows, or the sparse form.
bool is_matrix(const Value& value) { return value.kind == Kind::array || is_sparse_matrix(value); }

std::optional<std::vector<Matrix>> read_matrices(const Cursor& at) {
  if (!at.expect(Kind::array, "a list of matrices: [[[1, 2], [3, 4]], [[5, 6], [7, 8]]]"))
    return std::nullopt;
  std::vector<Matrix> all;
  bool good = true;
  for (std::size_t i = 0; i < at.size(); ++i) {
    auto A = read_matrix(at.item(i));
    good = good && A.has_value();
    if (A) all.push_back(std::move(*A));
  }
  return good ? std::optional<std::vector<Matrix>>(std::move(all)) : std::nullopt;
}

std::optional<ComponentSpec> read_nested(const Cursor& at, const Shelf& shelf,
                                         const ComponentContext& context, int depth);
std::optional<ComponentSpec> read_as_matrix(const Cursor& at, const std::string& type,
                                            const Shelf& shelf, const ComponentContext& context);

/// A component inside another one, as the parameter `param`.
std::optional<Params::Value> read_inner(const Cursor& at, const ParamSpec& param,
                                        const ComponentContext& context, int depth) {
  const std::string& kind = param.component_kind;
  const Shelf* shelf = shelf_of(kind);
  if (!shelf) {
    context.refusals.push_back(
        {at.pointer(),
         "asks for a component of the kind " + in_quotes(kind) + ", which does not exist",
         "report this to the author of the plugin", at.value().line});
    return std::nullopt;
  }
  if (depth == max_nesting) {
    at.error("components are nested more than " + std::to_string(max_nesting) + " deep",
             "use one with fewer components inside");
    return std::nullopt;
  }
  const bool short_form = !param.matrix_type.empty(), matrix = short_form && is_matrix(at.value());
  if (short_form && !matrix && !at.is(Kind::object) && !at.is(Kind::text) && !at.is(Kind::broken)) {
    at.error(
        "is " + std::string(kind_name(at.value().kind)) + ", must be a matrix, a text or an object",
        std::string("write a matrix, the name of ") + article(kind) + kind +
            ", or {\"type\": name, ...parameters}");
    return std::nullopt;
  }
  auto spec = matrix ? read_as_matrix(at, param.matrix_type, *shelf, context)
                     : read_nested(at, *shelf, context, depth + 1);
  if (!spec) return std::nullopt;
  return Params::Value(std::make_shared<const ComponentSpec>(std::move(*spec)));
}

std::optional<Params::Value> as_param(const ParamSpec& spec, const Cursor& at,
                                      const ComponentContext& context, int depth) {
  const auto wrap = [](auto&& read) {
    return read ? std::optional<Params::Value>(std::move(*read)) : std::nullopt;
  };
  switch (spec.kind) {
    case ParamKind::integer:
      return wrap(read_integer(at, spec.lowest, spec.highest));
    case ParamKind::real:
      return wrap(read_number(at));
    case ParamKind::flag:
      return wrap(read_flag(at));
    case ParamKind::choice:
      return wrap(read_choice(at, spec.choices));
    case ParamKind::text:
      return wrap(read_text(at, max_text));
    case ParamKind::vector:
      return wrap(read_vector(at));
    case ParamKind::matrix:
      return wrap(read_matrix(at));
    case ParamKind::set:
      return wrap(read_set(at, context.warnings));
    case ParamKind::matrices:
      return wrap(read_matrices(at));
    case ParamKind::component:
      return read_inner(at, spec, context, depth);
  }
  return std::nullopt;
}

/// The value that a relative pointer ("/name/0") leads to, or the last one on the way. What the
/// file does not hold is cut out of `relative`: "/type" where a component is written as its name
/// alone or as a matrix, "/matrix" where it is written as one.
const Value& target(const Cursor& at, std::string& relative) {
  const Value* value = &at.value();
  for (std::size_t begin = 1; begin <= relative.size();) {
    const std::size_t end = std::min(relative.find('/', begin), relative.size());
    const std::string step = relative.substr(begin, end - begin);
    const Value* next = value->find(step);
    if (value->kind == Kind::array && !step.empty() && step.size() < 8 &&
        step.find_first_not_of("0123456789") == std::string::npos) {
      const std::size_t index = std::stoul(step);
      if (index < value->items().size()) next = &value->items()[index];
    }
    if (!next) {
      const bool short_form = value->kind == Kind::text || is_matrix(*value);
      if (short_form && step == "type") relative.resize(begin - 1);
      if (!is_matrix(*value) || step != "matrix") break;
      relative.erase(begin - 1, step.size() + 1);
      continue;
    }
    value = next;
    begin = end + 1;
  }
  return *value;
}

void report(const Cursor& at, const Diagnostic& relative) {
  std::string pointer = relative.pointer;
  const int line = target(at, pointer).line;
  at.problems().add(at.pointer() + pointer, line, relative.message, relative.suggestion);
}

void read_params(const Cursor& at, const ParamSchema& schema, const std::string& component,
                 const ComponentContext& context, int depth, Params& params) {
  std::vector<std::string> names = schema.names();
  names.insert(names.begin(), "type");
  if (at.is(Kind::object)) at.expect_keys(names, "parameter of " + component, "");
  std::vector<std::string> wrong;
  for (const ParamSpec& spec : schema.specs()) {
    const auto value_at = at.find(spec.name);
    if (!value_at || spec.name == "type") continue;
    if (auto value = as_param(spec, *value_at, context, depth)) {
      params.set(spec.name, std::move(*value));
    } else {
      wrong.push_back(child("", spec.name));
    }
  }
  for (const Diagnostic& problem : schema.complete(params)) {
    if (std::find(wrong.begin(), wrong.end(), problem.pointer) == wrong.end()) report(at, problem);
  }
}

void report_unknown(const Cursor& type_at, const Shelf& shelf, const std::string& type,
                    const ComponentContext& context) {
  const std::string what = std::string("no ") + shelf.kind + " " + in_quotes(type);
  if (const PluginReport* refused = context.registry.refused_provider(type)) {
    const std::string reason =
        what + ": its plugin " + refused->file.string() + " was refused: " + refused->reason;
    context.refusals.push_back({type_at.pointer(), reason, refused->fix, type_at.value().line});
    return;
  }
  const std::vector<std::string> names = (context.registry.*shelf.names)();
  const std::string near = nearest(type, names),
                    doctor = "`cordon doctor` tells which plugins were found where";
  if (!names.empty()) {
    type_at.error(what, near.empty() ? suggest("", names) + "; " + doctor
                                     : "did you mean " + in_quotes(near) + "?");
    return;
  }
  const std::string none =
      what + ": no plugin of any " + shelf.kind + " was found";  // one cause, told once
  const auto told = [&](const Diagnostic& d) {
    return d.message.ends_with(none.substr(what.size()));
  };
  if (std::none_of(context.refusals.begin(), context.refusals.end(), told)) {
    context.refusals.push_back({type_at.pointer(), none, doctor, type_at.value().line});
  }
}

/// The component `type`, of which only its matrix is written.
std::optional<ComponentSpec> read_as_matrix(const Cursor& at, const std::string& type,
                                            const Shelf& shelf, const ComponentContext& context) {
  auto A = read_matrix(at);
  if (!A) return std::nullopt;
  const ComponentInfo* info = (context.registry.*shelf.info)(type);
  if (!info) {
    report_unknown(at, shelf, type, context);
    return std::nullopt;
  }
  ComponentSpec spec{type, Params().set("matrix", std::move(*A))};
  const std::vector<Diagnostic> problems = info->schema.complete(spec.params);
  for (const Diagnostic& problem : problems) report(at, problem);
  return problems.empty() ? std::optional<ComponentSpec>(std::move(spec)) : std::nullopt;
}

std::optional<ComponentSpec> read_nested(const Cursor& at, const Shelf& shelf,
                                         const ComponentContext& context, int depth) {
  const std::string form = std::string("write the name of ") + article(shelf.kind) + shelf.kind +
                           ", or {\"type\": name, ...parameters}";
  if (at.is(Kind::broken)) return std::nullopt;
  if (!at.is(Kind::object) && !at.is(Kind::text)) {
    at.error("is " + std::string(kind_name(at.value().kind)) + ", must be a text or an object",
             form);
    return std::nullopt;
  }
  const auto type_at = at.is(Kind::text) ? std::optional<Cursor>(at) : at.need("type", form);
  const auto type = type_at ? read_text(*type_at, max_name) : std::nullopt;
  if (!type) return std::nullopt;
  const ComponentInfo* info = (context.registry.*shelf.info)(*type);
  if (!info) {
    report_unknown(*type_at, shelf, *type, context);
    return std::nullopt;
  }
  const std::size_t before = at.problems().met();
  ComponentSpec spec{*type, {}};
  read_params(at, info->schema, std::string(shelf.kind) + " " + in_quotes(*type), context, depth,
              spec.params);
  return at.problems().met() == before ? std::optional<ComponentSpec>(std::move(spec))
                                       : std::nullopt;
}

/// What making or asking a component threw becomes a problem of its place: of the installation if
/// the plugin is at fault.
void report_failure(const Cursor& at, const Error& error, const ComponentContext& context) {
  if (error.code() == Errc::plugin) {
    context.refusals.push_back(
        {at.pointer(), error.what(), "report this to the author of the plugin", at.value().line});
  } else {
    at.error(error.what(), "");
  }
}

/// Asks a component what it says to its pipeline, and reports it at its place.
template <class Ask>
void ask(const Cursor& at, const ComponentContext& context, Ask&& check) {
  try {
    for (const Diagnostic& problem : check()) report(at, problem);
  } catch (const InputError& error) {  // of a nested component
    for (const Diagnostic& problem : error.diagnostics()) report(at, problem);
  } catch (const Error& error) {
    report_failure(at, error, context);
  }
}

/// Makes the backend and asks the algorithms whether they can work with it on this model, or on
/// these modes.
void check_together(const Cursor& pipeline, const PipelineSpec& spec, const SystemPart& system,
                    const ModeBank& bank, const ComponentContext& context) {
  const Registry& registry = context.registry;
  std::shared_ptr<const SetBackend> backend;
  try {
    backend = registry.make_backend(spec.backend.type, spec.backend.params);
  } catch (const Error& error) {
    return report_failure(*pipeline.find("backend"), error, context);
  }
  if (spec.designer) {
    ask(*pipeline.find("designer"), context, [&] {
      return registry.check_designer(spec.designer->type, bank, backend, spec.designer->params);
    });
  }
  if (spec.diagnoser) {
    ask(*pipeline.find("diagnoser"), context, [&] {
      return registry.check_diagnoser(spec.diagnoser->type, bank, backend, spec.diagnoser->params);
    });
  }
  if (!spec.designer && !spec.diagnoser) {
    ask(*pipeline.find("observer"), context, [&] {
      return registry.check_observer(spec.observer.type, {system.model, backend},
                                     spec.observer.params);
    });
  }
}

/// The observer, or the designer and the diagnoser of a pipeline; false if they are not right.
bool read_algorithm(const Cursor& at, const ComponentContext& context, PipelineSpec& spec) {
  const auto observer_at = at.find("observer"), diagnoser_at = at.find("diagnoser"),
             designer_at = at.find("designer");
  if (observer_at && (diagnoser_at || designer_at)) {
    at.error(std::string("holds both \"observer\" and ") +
                 (designer_at ? "\"designer\"" : "\"diagnoser\""),
             "remove one of the two, or make two pipelines");
    return false;
  }
  if (observer_at) {
    auto observer = read_component(*observer_at, "observer", context);
    if (observer) spec.observer = std::move(*observer);
    return observer.has_value();
  }
  if (!diagnoser_at && !designer_at) {
    at.error("holds neither \"observer\" nor \"diagnoser\" nor \"designer\"",
             "name the algorithm: \"observer\" estimates the state, \"diagnoser\" finds out the "
             "mode, \"designer\" designs an input "
             "that shows it");
    return false;
  }
  if (designer_at) spec.designer = read_component(*designer_at, "designer", context);
  if (diagnoser_at) spec.diagnoser = read_component(*diagnoser_at, "diagnoser", context);
  return spec.designer.has_value() == designer_at.has_value() &&
         spec.diagnoser.has_value() == diagnoser_at.has_value();
}

PipelineSpec read_pipeline(const Cursor& at, const SystemPart& system, const ModeBank& bank,
                           const ComponentContext& context, bool asks) {
  PipelineSpec spec;
  const std::string form =
      "{\"name\": ..., \"backend\": {\"type\": ...}, \"observer\": {\"type\": ...}}";
  if (!at.expect_keys({"name", "backend", "observer", "diagnoser", "designer"}, "key of a pipeline",
                      form))
    return spec;
  const auto backend_at = at.need("backend", "the set representation: {\"type\": ...}");
  const auto backend = backend_at ? read_component(*backend_at, "backend", context) : std::nullopt;
  const bool algorithm = read_algorithm(at, context, spec);
  if (const auto name_at = at.find("name")) {
    spec.name = read_line(*name_at, max_name).value_or("");
  } else if (backend) {
    spec.name = backend->type;
  }
  if (!backend || !algorithm) return spec;
  spec.backend = *backend;
  const bool bank_wide = spec.diagnoser || spec.designer;
  if (asks && (bank_wide ? system.modes_good : system.good))
    check_together(at, spec, system, bank, context);
  return spec;
}

}  // namespace

const Shelf* shelf_of(std::string_view kind) {
  static constexpr Shelf shelves[] = {
      {"backend", &Registry::backend_info, &Registry::backends},
      {"observer", &Registry::observer_info, &Registry::observers},
      {"metric", &Registry::metric_info, &Registry::metrics},
      {"diagnoser", &Registry::diagnoser_info, &Registry::diagnosers},
      {"plant", &Registry::plant_info, &Registry::plants},
      {"gain", &Registry::gain_info, &Registry::gains},
      {"designer", &Registry::designer_info, &Registry::designers}};
  const auto found = std::find_if(std::begin(shelves), std::end(shelves),
                                  [&](const Shelf& shelf) { return kind == shelf.kind; });
  return found == std::end(shelves) ? nullptr : found;
}

std::optional<ComponentSpec> read_component(const Cursor& at, std::string_view kind,
                                            const ComponentContext& context) {
  return read_nested(at, *shelf_of(kind), context, 1);
}

void read_plant(const Cursor& at, const SystemPart& system, SimulateSpec& spec,
                const ComponentContext& context) {
  spec.plant = read_component(at, "plant", context);
  if (!spec.plant) return;
  try {
    spec.made_plant = context.registry.make_plant(spec.plant->type, spec.plant->params);
    const Plant& plant = *spec.made_plant;
    const auto compare = [&](Index size, std::optional<Index> wanted, const char* noun) {
      if (!wanted || size == *wanted) return;
      at.error("has " + counted(size, noun) + ", /system has " + std::to_string(*wanted),
               "the linear model is one of this plant: the same states, inputs and outputs");
    };
    compare(plant.states(), system.sizes.states, "state");
    compare(plant.inputs(), system.sizes.inputs, "input");
    compare(plant.outputs(), system.sizes.outputs, "output");
  } catch (const Error& error) {
    report_failure(at, error, context);
  }
}

std::vector<PipelineSpec> read_pipelines(const Cursor& at, const SystemPart& system,
                                         const ComponentContext& context,
                                         const std::function<bool(std::size_t)>& asks) {
  std::vector<PipelineSpec> specs;
  if (!at.expect(Kind::array, "a list of pipelines: [{\"backend\": ..., \"observer\": ...}]"))
    return specs;
  if (at.size() == 0) at.error("is an empty list", "give at least one pipeline");
  if (at.size() > max_pipelines) {
    at.error("holds more than " + std::to_string(max_pipelines) + " pipelines");
    return specs;
  }
  ModeBank bank;
  if (system.modes_good) bank.modes.push_back({system.nominal, system.model});
  bank.modes.insert(bank.modes.end(), system.modes.begin(), system.modes.end());
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Cursor item = at.item(i);
    specs.push_back(read_pipeline(item, system, bank, context, asks(i)));
    const std::string& name = specs.back().name;
    if (name.empty()) continue;
    const auto [first, fresh] = seen.emplace(name, i);
    if (fresh) continue;
    const std::string other = child(at.pointer(), first->second);
    if (const auto name_at = item.find("name")) {
      name_at->error("repeats the name of " + other, "names of pipelines are unique");
    } else {
      item.error("has the same name as " + other + ": " + in_quotes(name) +
                     ", by default that of its backend",
                 "give it a \"name\"");
    }
  }
  return specs;
}

std::vector<ComponentSpec> read_metrics(const Cursor& at, const SystemPart& system,
                                        const ComponentContext& context) {
  std::vector<ComponentSpec> specs;
  if (!at.expect(Kind::array, "a list of metrics: [\"radius\", ...]")) return specs;
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < at.size(); ++i) {
    auto spec = read_component(at.item(i), "metric", context);
    if (!spec) continue;
    const auto [first, fresh] = seen.emplace(spec->type, i);
    if (!fresh)
      at.item(i).error("repeats " + child(at.pointer(), first->second), "remove one of the two");
    if (system.good) {
      ask(at.item(i), context,
          [&] { return context.registry.check_metric(spec->type, {system.model}, spec->params); });
    }
    specs.push_back(std::move(*spec));
  }
  return specs;
}

}  // namespace cordon::json
