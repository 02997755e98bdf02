// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of the JSON Schema of studies.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cordon/registry/registry.hpp"

namespace cordon::schema_parts {

using Json = nlohmann::ordered_json;

inline Json reference(const std::string& name) { return {{"$ref", "#/$defs/" + name}}; }
inline Json described(Json schema, const std::string& text) {
  schema["description"] = text;
  return schema;
}
inline Json integer(std::int64_t lowest, std::int64_t highest) {
  return {{"type", "integer"}, {"minimum", lowest}, {"maximum", highest}};
}
inline Json text(int longest) {
  return {{"type", "string"}, {"minLength", 1}, {"maxLength", longest}};
}
inline Json list_of(Json items) { return {{"type", "array"}, {"items", std::move(items)}}; }
inline Json one_of(const std::vector<std::string>& words) { return {{"enum", words}}; }

/// An object with these properties only; $comment and $schema are allowed everywhere.
inline Json object(Json properties, const std::vector<std::string>& required) {
  properties["$comment"] = true;
  properties["$schema"] = {{"type", "string"}};
  Json schema{
      {"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = required;
  return schema;
}

inline Json typed(const std::string& type, Json properties, std::vector<std::string> required) {
  Json all{{"type", {{"const", type}}}};
  all.update(properties);
  required.insert(required.begin(), "type");
  return object(std::move(all), required);
}

/// The section "data".
Json data();

/// Systems by formulas: written in the study, or those of a plant.
std::array<Json, 2> nonlinear_systems(const Json& names, const Json& sampling_time);

/// Components of one kind: the name alone where no parameter is required, or an object by "type".
Json components(const Registry& registry, const std::string& kind);

}  // namespace cordon::schema_parts
