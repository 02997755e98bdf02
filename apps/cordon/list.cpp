// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "json_text.hpp"

namespace cordon::apps {

namespace {

std::string as_json(const std::vector<Component>& found) {
  auto entries = nlohmann::ordered_json::array();
  for (const Component& c : found) {
    entries.push_back({{"kind", c.kind},
                       {"name", c.info->name},
                       {"plugin", c.plugin},
                       {"summary", c.info->summary},
                       {"citation", c.info->citation}});
  }
  return json_text(nlohmann::ordered_json{{"components", std::move(entries)}});
}

std::string as_table(const std::vector<Component>& found) {
  std::vector<std::vector<std::string>> rows{{"KIND", "NAME", "PLUGIN", "SUMMARY"}};
  for (const Component& c : found)
    rows.push_back({c.kind, c.info->name, c.plugin, c.info->summary});
  return table(rows, Paint(stdout));
}

}  // namespace

Exit list_components(const Program& program, bool json) {
  Registry registry;
  load_plugins(registry, program.plugins);
  warn_refused(registry);
  const auto found = components(registry);
  if (found.empty())
    warn("no components were found; `cordon doctor` tells where plugins are searched");
  print(json ? as_json(found) : as_table(found));
  return Exit::done;
}

CORDON_COMMAND(list) {
  CLI::App* command =
      app.add_subcommand("list", fmt::format("List components with their plugins, by kind: {}",
                                             fmt::join(Registry::kinds(), ", ")));
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Print JSON for programs");
  command->callback([&program, json] { program.exit = list_components(program, *json); });
}

}  // namespace cordon::apps
