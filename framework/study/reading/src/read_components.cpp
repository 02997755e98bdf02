// SPDX-License-Identifier: GPL-3.0-or-later
// Components with their parameters, components inside them included.
#include <algorithm>
#include <map>

#include "reported_problems.hpp"
#include "study/reading/read_parts.hpp"
#include "study/reading/read_sets.hpp"

namespace cordon::json {

namespace {

using Kind = Value::Kind;
constexpr std::size_t max_text = 65536;
constexpr int max_nesting = 8;  // of components

const char* article(std::string_view kind) {
  return std::string_view("aeiou").find(kind.front()) != std::string_view::npos ? "an " : "a ";
}

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

std::optional<ComponentSpec> read_nested(const Cursor& at, const std::string& kind,
                                         const ComponentContext& context, int depth);
std::optional<ComponentSpec> read_as_matrix(const Cursor& at, const std::string& type,
                                            const std::string& kind,
                                            const ComponentContext& context);

/// A component inside another one, as the parameter `param`.
std::optional<Params::Value> read_inner(const Cursor& at, const ParamSpec& param,
                                        const ComponentContext& context, int depth) {
  const std::string& kind = param.component_kind;
  if (!is_kind(kind)) {
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
  auto spec = matrix ? read_as_matrix(at, param.matrix_type, kind, context)
                     : read_nested(at, kind, context, depth + 1);
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

/// {"at_most": n} in the place of an integer.
std::optional<std::int64_t> read_at_most(const Cursor& at, const ParamSpec& most) {
  if (!at.expect_keys({"at_most"}, "bound", "write a number, or {\"at_most\": number}"))
    return std::nullopt;
  const auto value = at.find("at_most");
  if (!value) at.error("has no \"at_most\"", "write a number, or {\"at_most\": number}");
  return value ? read_integer(*value, most.lowest, most.highest) : std::nullopt;
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
    const ParamSpec* most = schema.find(spec.at_most);
    if (most && value_at->is(Kind::object)) {
      if (const auto other = at.find(most->name)) {
        other->error("is given by " + in_quotes(spec.name) + " as well", "remove one of the two");
      } else if (const auto value = read_at_most(*value_at, *most)) {
        params.set(most->name, *value);
      }
      wrong.push_back(child("", spec.name));
      continue;
    }
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

void report_unknown(const Cursor& type_at, const std::string& kind, const std::string& type,
                    const ComponentContext& context) {
  const std::string what = "no " + kind + " " + in_quotes(type);
  if (const PluginReport* refused = context.registry.refused_provider(type)) {
    const std::string reason =
        what + ": its plugin " + refused->file.string() + " was refused: " + refused->reason;
    context.refusals.push_back({type_at.pointer(), reason, refused->fix, type_at.value().line});
    return;
  }
  const std::vector<std::string> names = context.registry.names(kind);
  const std::string near = nearest(type, names),
                    doctor = "`cordon doctor` tells which plugins were found where";
  if (!names.empty()) {
    type_at.error(what, near.empty() ? suggest("", names) + "; " + doctor
                                     : "did you mean " + in_quotes(near) + "?");
    return;
  }
  const std::string none =
      what + ": no plugin of any " + kind + " was found";  // one cause, told once
  const auto told = [&](const Diagnostic& d) {
    return d.message.ends_with(none.substr(what.size()));
  };
  if (std::none_of(context.refusals.begin(), context.refusals.end(), told)) {
    context.refusals.push_back({type_at.pointer(), none, doctor, type_at.value().line});
  }
}

/// The component `type`, of which only its matrix is written.
std::optional<ComponentSpec> read_as_matrix(const Cursor& at, const std::string& type,
                                            const std::string& kind,
                                            const ComponentContext& context) {
  auto A = read_matrix(at);
  if (!A) return std::nullopt;
  const ComponentInfo* info = context.registry.info(kind, type);
  if (!info) {
    report_unknown(at, kind, type, context);
    return std::nullopt;
  }
  ComponentSpec spec{type, Params().set("matrix", std::move(*A))};
  const std::vector<Diagnostic> problems = info->schema.complete(spec.params);
  for (const Diagnostic& problem : problems) report(at, problem);
  return problems.empty() ? std::optional<ComponentSpec>(std::move(spec)) : std::nullopt;
}

std::optional<ComponentSpec> read_nested(const Cursor& at, const std::string& kind,
                                         const ComponentContext& context, int depth) {
  const std::string form = std::string("write the name of ") + article(kind) + kind +
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
  const ComponentInfo* info = context.registry.info(kind, *type);
  if (!info) {
    report_unknown(*type_at, kind, *type, context);
    return std::nullopt;
  }
  const std::size_t before = at.problems().met();
  ComponentSpec spec{*type, {}};
  read_params(at, info->schema, kind + " " + in_quotes(*type), context, depth, spec.params);
  return at.problems().met() == before ? std::optional<ComponentSpec>(std::move(spec))
                                       : std::nullopt;
}

}  // namespace

void report(const Cursor& at, const Diagnostic& relative) {
  std::string pointer = relative.pointer;
  const int line = target(at, pointer).line;
  at.problems().add(at.pointer() + pointer, line, relative.message, relative.suggestion);
}

bool is_kind(const std::string& kind) {
  const std::vector<std::string>& kinds = Registry::kinds();
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

std::optional<ComponentSpec> read_component(const Cursor& at, const std::string& kind,
                                            const ComponentContext& context) {
  return read_nested(at, kind, context, 1);
}

}  // namespace cordon::json
