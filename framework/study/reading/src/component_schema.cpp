// SPDX-License-Identifier: GPL-3.0-or-later
// The JSON Schema of components, from the schemas of their parameters.
#include <cmath>
#include <limits>

#include "schema_parts.hpp"
#include "study/reading/read_parts.hpp"

namespace cordon::schema_parts {

namespace {

void add_limits(Json& schema, const ParamSpec& spec) {
  const bool whole = spec.kind == ParamKind::integer;
  const auto limit = [&](double x) { return whole ? Json(static_cast<std::int64_t>(x)) : Json(x); };
  if (spec.lowest > -infinity && std::abs(spec.lowest) <= json::max_integer)
    schema["minimum"] = limit(spec.lowest);
  if (spec.highest < infinity && std::abs(spec.highest) <= json::max_integer)
    schema["maximum"] = limit(spec.highest);
}

Json parameter(const ParamSpec& spec) {
  Json schema;
  switch (spec.kind) {
    case ParamKind::integer:
      schema["type"] = "integer";
      break;
    case ParamKind::real:
      schema["type"] = "number";
      break;
    case ParamKind::flag:
      schema["type"] = "boolean";
      break;
    case ParamKind::choice:
      schema = one_of(spec.choices);
      break;
    case ParamKind::text:
      schema["type"] = "string";
      break;
    case ParamKind::vector:
      schema = reference("vector");
      break;
    case ParamKind::matrix:
      schema = reference("matrix");
      break;
    case ParamKind::set:
      schema = reference("set");
      break;
    case ParamKind::matrices:
      schema = list_of(reference("matrix"));
      break;
    case ParamKind::component:
      schema = reference(spec.component_kind);
      if (!spec.matrix_type.empty()) schema = {{"anyOf", {reference("matrix"), schema}}};
      break;
  }
  if (spec.kind == ParamKind::integer || spec.kind == ParamKind::real) add_limits(schema, spec);
  if (!spec.at_most.empty()) {
    Json most = {{"type", "object"},
                 {"properties", {{"at_most", schema}}},
                 {"required", {"at_most"}},
                 {"additionalProperties", false}};
    schema = {{"anyOf", {schema, most}}};
  }
  if (spec.fallback) {
    if (const auto* value = std::get_if<std::int64_t>(&*spec.fallback)) schema["default"] = *value;
    if (const auto* value = std::get_if<double>(&*spec.fallback)) schema["default"] = *value;
    if (const auto* value = std::get_if<bool>(&*spec.fallback)) schema["default"] = *value;
    if (const auto* value = std::get_if<std::string>(&*spec.fallback)) schema["default"] = *value;
  }
  return described(std::move(schema), spec.doc);
}

}  // namespace

Json components(const Registry& registry, const std::string& kind) {
  Json all = Json::array();
  std::vector<std::string> plain;
  for (const std::string& name : registry.names(kind)) {
    const ComponentInfo& component = *registry.info(kind, name);
    Json properties = Json::object();
    std::vector<std::string> required;
    for (const ParamSpec& spec : component.schema.specs()) {
      properties[spec.name] = parameter(spec);
      if (spec.required) required.push_back(spec.name);
    }
    if (required.empty()) plain.push_back(name);
    all.push_back(described(typed(name, properties, required), component.summary));
  }
  if (!plain.empty()) all.push_back(one_of(plain));
  if (all.empty()) return false;  // nothing is valid: no plugin provides one
  return {{"oneOf", all}};
}

}  // namespace cordon::schema_parts
