// SPDX-License-Identifier: GPL-3.0-or-later
// Parameters from JSON, by the schema of the component; the plugin's library alone.
#include "conform_component.hpp"

#include <cstdint>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void wrong_param(const std::string& name, const std::string& expected) {
  throw Error(Errc::invalid, fmt::format("--params: \"{}\" must be {}", name, expected));
}

Vector vector_from(const Json& json, const std::string& name) {
  if (!json.is_array()) wrong_param(name, "an array of numbers");
  Vector x(static_cast<Index>(json.size()));
  for (std::size_t i = 0; i < json.size(); ++i) {
    if (!json[i].is_number()) wrong_param(name, "an array of numbers");
    x[static_cast<Index>(i)] = json[i].get<double>();
  }
  return x;
}

Params::Value value_from(const Json& json, const ParamSpec& spec) {
  switch (spec.kind) {
    case ParamKind::integer:
      if (!json.is_number_integer()) wrong_param(spec.name, "an integer");
      return json.get<std::int64_t>();
    case ParamKind::real:
      if (!json.is_number()) wrong_param(spec.name, "a number");
      return json.get<double>();
    case ParamKind::flag:
      if (!json.is_boolean()) wrong_param(spec.name, "true or false");
      return json.get<bool>();
    case ParamKind::choice:
    case ParamKind::text:
      if (!json.is_string()) wrong_param(spec.name, "a text");
      return json.get<std::string>();
    case ParamKind::vector:
      return vector_from(json, spec.name);
    case ParamKind::matrix: {
      if (!json.is_array() || json.empty()) wrong_param(spec.name, "an array of rows");
      const Vector first = vector_from(json[0], spec.name);
      Matrix A(static_cast<Index>(json.size()), first.size());
      for (std::size_t i = 0; i < json.size(); ++i) {
        const Vector row = vector_from(json[i], spec.name);
        if (row.size() != first.size())
          wrong_param(spec.name, "an array of rows of the same length");
        A.row(static_cast<Index>(i)) = row.transpose();
      }
      return A;
    }
    case ParamKind::set:
    case ParamKind::matrices:
    case ParamKind::component:
      break;
  }
  throw Error(Errc::invalid, fmt::format("--params: \"{}\" is a {}, which cannot be given here",
                                         spec.name, to_string(spec.kind)));
}

}  // namespace

Params params_from(const std::string& text, const ParamSchema& schema, bool complete) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& error) {
    throw Error(Errc::invalid, fmt::format("--params is no JSON: {}", error.what()));
  }
  if (!json.is_object())
    throw Error(Errc::invalid,
                "--params must be a JSON object, such as '{\"rounding\": \"outward\"}'");
  Params params;
  for (const auto& [name, value] : json.items()) {
    const ParamSpec* spec = schema.find(name);
    if (!spec) {
      throw Error(Errc::invalid, fmt::format("--params: there is no parameter \"{}\"; {}", name,
                                             suggest(name, schema.names())));
    }
    params.set(name, value_from(value, *spec));
  }
  Params completed = params;
  std::vector<Diagnostic> problems = schema.complete(completed);
  // what a law finds out by trial may be missing; what was given is checked
  if (!complete) {
    std::erase_if(problems, [&](const Diagnostic& problem) {
      return problem.pointer.empty() || !params.has(problem.pointer.substr(1));
    });
  }
  if (!problems.empty()) throw InputError("--params", problems);
  return complete ? completed : params;
}

void load_only(Registry& registry, const std::filesystem::path& library) {
  const PluginReport& report = registry.load_file(library);
  if (report.state == PluginReport::State::loaded) return;
  throw Error(Errc::plugin,
              fmt::format("{} was refused: {}; {}", library.string(), report.reason, report.fix));
}

}  // namespace cordon::apps
