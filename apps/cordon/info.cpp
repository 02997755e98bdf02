// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "json_text.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  if (std::isnan(value)) return nullptr;
  return std::isfinite(value) ? Json(value) : Json(value > 0 ? "inf" : "-inf");
}

Json as_json(const ParamSpec& spec) {
  Json json{{"name", spec.name},
            {"type", to_string(spec.kind)},
            {"required", spec.required},
            {"doc", spec.doc}};
  if (spec.fallback) {
    if (const auto* integer = std::get_if<std::int64_t>(&*spec.fallback))
      json["default"] = *integer;
    if (const auto* real = std::get_if<double>(&*spec.fallback)) json["default"] = number(*real);
    if (const auto* flag = std::get_if<bool>(&*spec.fallback)) json["default"] = *flag;
    if (const auto* text = std::get_if<std::string>(&*spec.fallback)) json["default"] = *text;
  }
  if (spec.kind == ParamKind::integer || spec.kind == ParamKind::real) {
    json["lowest"] = number(spec.lowest);
    json["highest"] = number(spec.highest);
  }
  if (spec.kind == ParamKind::choice) json["choices"] = spec.choices;
  if (spec.kind == ParamKind::component) json["kind"] = spec.component_kind;
  if (!spec.matrix_type.empty()) json["matrix_type"] = spec.matrix_type;
  if (!spec.at_most.empty()) json["at_most"] = spec.at_most;
  return json;
}

Json as_json(const Component& component) {
  Json params = Json::array();
  for (const ParamSpec& spec : component.info->schema.specs()) params.push_back(as_json(spec));
  return {{"kind", component.kind},
          {"name", component.info->name},
          {"plugin", component.plugin},
          {"summary", component.info->summary},
          {"citation", component.info->citation},
          {"details", component.info->details},
          {"params", std::move(params)}};
}

std::string as_text(const Component& component, const Paint& paint) {
  const ComponentInfo& info = *component.info;
  std::string text = paint.bold(component.kind + " " + info.name) + " (plugin " + component.plugin +
                     ")\n" + info.summary + "\n";
  if (!info.citation.empty()) text += "Source: " + info.citation + "\n";
  if (!info.details.empty())
    text += "\n" + info.details + (info.details.ends_with('\n') ? "" : "\n");
  if (info.schema.specs().empty())
    return text + (info.details.empty() ? "" : "\n") + "It takes no parameters.\n";
  std::vector<std::vector<std::string>> rows{{"PARAMETER", "TYPE", "DEFAULT", "RANGE", "MEANING"}};
  for (const ParamSpec& spec : info.schema.specs()) {
    rows.push_back({spec.name, std::string(to_string(spec.kind)), default_text(spec),
                    range_text(spec), spec.doc});
  }
  return text + "\n" + table(rows, paint);
}

/// Components of that name, of every kind; an unknown name is an error with a suggestion.
std::vector<Component> matching(const Registry& registry, const std::string& name) {
  std::vector<Component> matches;
  std::vector<std::string> names;
  for (const Component& component : components(registry)) {
    names.push_back(component.info->name);
    if (component.info->name == name) matches.push_back(component);
  }
  if (!matches.empty()) return matches;
  if (const PluginReport* refused = registry.refused_provider(name)) {
    throw Error(Errc::plugin, fmt::format("no component \"{}\": {} was refused: {}; {}", name,
                                          refused->file.string(), refused->reason, refused->fix));
  }
  const std::string suggestion =
      names.empty() ? "no plugin was found, see `cordon doctor`" : suggest(name, names);
  throw Error(Errc::invalid, fmt::format("no component \"{}\"; {}", name, suggestion));
}

Exit info(const Program& program, const std::vector<std::string>& names, bool json) {
  Registry registry;
  load_plugins(registry, program.plugins);
  std::vector<Component> matches;
  for (const std::string& name : names) {
    for (const Component& component : matching(registry, name)) matches.push_back(component);
  }
  warn_refused(registry);
  if (json) {
    Json entries = Json::array();
    for (const Component& component : matches) entries.push_back(as_json(component));
    print(json_text(Json{{"components", std::move(entries)}}));
    return Exit::done;
  }
  const Paint paint(stdout);
  std::string text;
  for (const Component& component : matches)
    text += (text.empty() ? "" : "\n") + as_text(component, paint);
  print(text);
  return Exit::done;
}

}  // namespace

CORDON_COMMAND(info) {
  CLI::App* command = app.add_subcommand("info", "Explain components and their parameters");
  const auto names = std::make_shared<std::vector<std::string>>();
  const auto json = std::make_shared<bool>(false);
  CLI::Option* const given = command->add_option(
      "COMPONENT", *names, "Names of components of any kind; without one all are listed");
  command->add_flag("--json", *json, "Print JSON for programs");
  command->callback([&program, names, json, given] {
    const bool all = given->count() == 0;
    program.exit = all ? list_components(program, *json) : info(program, *names, *json);
    if (all && !*json) print("\n\"cordon info NAME\" explains one of them.\n");
  });
}

}  // namespace cordon::apps
