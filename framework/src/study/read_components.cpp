// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>

#include "study/read_parts.hpp"
#include "study/read_sets.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;
constexpr std::size_t max_name = 200;
constexpr std::size_t max_text = 65536;
constexpr std::size_t max_pipelines = 1000;

/// What the registry knows about one kind of component.
struct Shelf {
  const char* kind;
  const ComponentInfo* (Registry::*info)(std::string_view) const;
  std::vector<std::string> (Registry::*names)() const;
};
constexpr Shelf backend_shelf{"backend", &Registry::backend_info, &Registry::backends};
constexpr Shelf observer_shelf{"observer", &Registry::observer_info, &Registry::observers};
constexpr Shelf metric_shelf{"metric", &Registry::metric_info, &Registry::metrics};

std::optional<Params::Value> as_param(const ParamSpec& spec, const Cursor& at, std::vector<std::string>& warnings) {
  const auto wrap = [](auto&& read) { return read ? std::optional<Params::Value>(std::move(*read)) : std::nullopt; };
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
      return wrap(read_set(at, warnings));
    case ParamKind::matrices:
    case ParamKind::component:
      break;
  }
  return std::nullopt;
}

/// Line of the last value that a relative pointer ("/name/0") leads to.
int line_of(const Cursor& at, const std::string& relative) {
  const Value* value = &at.value();
  for (std::size_t begin = 1; begin <= relative.size() && value;) {
    const std::size_t end = std::min(relative.find('/', begin), relative.size());
    const std::string step = relative.substr(begin, end - begin);
    const Value* next = value->find(step);
    if (value->kind == Kind::array && !step.empty() && step.size() < 8 &&
        step.find_first_not_of("0123456789") == std::string::npos) {
      const std::size_t index = std::stoul(step);
      if (index < value->items().size()) next = &value->items()[index];
    }
    if (!next) break;
    value = next;
    begin = end + 1;
  }
  return value->line;
}

void report(const Cursor& at, const Diagnostic& relative) {
  at.problems().add(at.pointer() + relative.pointer, line_of(at, relative.pointer), relative.message, relative.suggestion);
}

void read_params(const Cursor& at, const ParamSchema& schema, const std::string& component, const ComponentContext& context,
                 Params& params) {
  std::vector<std::string> names = schema.names();
  names.insert(names.begin(), "type");
  if (at.is(Kind::object)) at.expect_keys(names, "parameter of " + component, "");
  std::vector<std::string> wrong;
  for (const ParamSpec& spec : schema.specs()) {
    const auto value_at = at.find(spec.name);
    if (!value_at || spec.name == "type") continue;
    if (auto value = as_param(spec, *value_at, context.warnings)) {
      params.set(spec.name, std::move(*value));
    } else {
      wrong.push_back(child("", spec.name));
    }
  }
  for (const Diagnostic& problem : schema.complete(params)) {
    if (std::find(wrong.begin(), wrong.end(), problem.pointer) == wrong.end()) report(at, problem);
  }
}

void report_unknown(const Cursor& type_at, const Shelf& shelf, const std::string& type, const ComponentContext& context) {
  const std::string what = std::string("no ") + shelf.kind + " " + in_quotes(type);
  if (const PluginReport* refused = context.registry.refused_provider(type)) {
    const std::string reason = what + ": its plugin " + refused->file.string() + " was refused: " + refused->reason;
    context.refusals.push_back({type_at.pointer(), reason, refused->fix, type_at.value().line});
    return;
  }
  const std::vector<std::string> names = (context.registry.*shelf.names)();
  const std::string near = nearest(type, names), doctor = "`cordon doctor` tells which plugins were found where";
  if (!names.empty()) {
    type_at.error(what, near.empty() ? suggest("", names) + "; " + doctor : "did you mean " + in_quotes(near) + "?");
    return;
  }
  const std::string none = what + ": no plugin of any " + shelf.kind + " was found";  // one cause, told once
  const auto told = [&](const Diagnostic& d) { return d.message.ends_with(none.substr(what.size())); };
  if (std::none_of(context.refusals.begin(), context.refusals.end(), told)) {
    context.refusals.push_back({type_at.pointer(), none, doctor, type_at.value().line});
  }
}

/// A component: its name, or an object of "type" and parameters.
std::optional<ComponentSpec> read_component(const Cursor& at, const Shelf& shelf, const ComponentContext& context) {
  const std::string form = std::string("write the name of a ") + shelf.kind + ", or {\"type\": name, ...parameters}";
  if (at.is(Kind::broken)) return std::nullopt;
  if (!at.is(Kind::object) && !at.is(Kind::text)) {
    at.error("is " + std::string(kind_name(at.value().kind)) + ", must be a text or an object", form);
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
  read_params(at, info->schema, std::string(shelf.kind) + " " + in_quotes(*type), context, spec.params);
  return at.problems().met() == before ? std::optional<ComponentSpec>(std::move(spec)) : std::nullopt;
}

/// Makes the backend and asks the observer whether it can work with it on this model. What a plugin throws becomes a problem of
/// its place.
void check_together(const Cursor& pipeline, const PipelineSpec& spec, const Model& model, const ComponentContext& context) {
  const auto failed = [&](const char* part, const Error& error) {
    const Cursor at = *pipeline.find(part);
    if (error.code() == Errc::plugin) {
      context.refusals.push_back({at.pointer(), error.what(), "report this to the author of the plugin", at.value().line});
    } else {
      at.error(error.what(), "");
    }
  };
  std::shared_ptr<const SetBackend> backend;
  try {
    backend = context.registry.make_backend(spec.backend.type, spec.backend.params);
  } catch (const Error& error) {
    return failed("backend", error);
  }
  try {
    const Cursor observer = *pipeline.find("observer");
    for (const Diagnostic& problem :
         context.registry.check_observer(spec.observer.type, {model, backend}, spec.observer.params)) {
      report(observer, problem);
    }
  } catch (const Error& error) {
    failed("observer", error);
  }
}

PipelineSpec read_pipeline(const Cursor& at, const SystemPart& system, const ComponentContext& context) {
  PipelineSpec spec;
  const std::string form = "{\"name\": ..., \"backend\": {\"type\": ...}, \"observer\": {\"type\": ...}}";
  if (!at.expect_keys({"name", "backend", "observer"}, "key of a pipeline", form)) return spec;
  const auto backend_at = at.need("backend", "the set representation: {\"type\": ...}");
  const auto observer_at = at.need("observer", "the estimation algorithm: {\"type\": ...}");
  const auto backend = backend_at ? read_component(*backend_at, backend_shelf, context) : std::nullopt;
  const auto observer = observer_at ? read_component(*observer_at, observer_shelf, context) : std::nullopt;
  if (const auto name_at = at.find("name")) {
    spec.name = read_text(*name_at, max_name).value_or("");
  } else if (backend) {
    spec.name = backend->type;
  }
  if (!backend || !observer) return spec;
  spec.backend = *backend;
  spec.observer = *observer;
  if (system.good) check_together(at, spec, system.model, context);
  return spec;
}

}  // namespace

std::vector<PipelineSpec> read_pipelines(const Cursor& at, const SystemPart& system, const ComponentContext& context) {
  std::vector<PipelineSpec> specs;
  if (!at.expect(Kind::array, "a list of pipelines: [{\"backend\": ..., \"observer\": ...}]")) return specs;
  if (at.size() == 0) at.error("is an empty list", "give at least one pipeline");
  if (at.size() > max_pipelines) {
    at.error("holds more than " + std::to_string(max_pipelines) + " pipelines");
    return specs;
  }
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Cursor item = at.item(i);
    specs.push_back(read_pipeline(item, system, context));
    const std::string& name = specs.back().name;
    if (name.empty()) continue;
    const auto [first, fresh] = seen.emplace(name, i);
    if (fresh) continue;
    const std::string other = child(at.pointer(), first->second);
    if (const auto name_at = item.find("name")) {
      name_at->error("repeats the name of " + other, "names of pipelines are unique");
    } else {
      item.error("has the same name as " + other + ": " + in_quotes(name) + ", by default that of its backend",
                 "give it a \"name\"");
    }
  }
  return specs;
}

std::vector<ComponentSpec> read_metrics(const Cursor& at, const ComponentContext& context) {
  std::vector<ComponentSpec> specs;
  if (!at.expect(Kind::array, "a list of metrics: [\"radius\", ...]")) return specs;
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < at.size(); ++i) {
    auto spec = read_component(at.item(i), metric_shelf, context);
    if (!spec) continue;
    const auto [first, fresh] = seen.emplace(spec->type, i);
    if (!fresh) at.item(i).error("repeats " + child(at.pointer(), first->second), "remove one of the two");
    specs.push_back(std::move(*spec));
  }
  return specs;
}

}  // namespace cordon::json
