// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "cordon/registry/build.hpp"
#include "cordon/study/verify.hpp"
#include "json_text.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::vector<std::pair<std::string, std::string>> versions(const BuildInfo& build) {
  std::vector<std::pair<std::string, std::string>> versions{{"cordon", build.version}};
  versions.insert(versions.end(), build.tools.begin(), build.tools.end());
  versions.emplace_back("nlohmann_json",
                        fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                    NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH));
  versions.emplace_back("cddlib", cddlib_version());
  return versions;
}

bool is_present(const fs::path& directory) {
  std::error_code error;
  return fs::is_directory(directory, error);
}

std::string as_json(const BuildInfo& build, const SearchPath& path, const Registry& registry) {
  Json json{{"versions", Json::object()},
            {"abi_tag", build.abi_tag},
            {"search_path", Json::array()},
            {"plugins", Json::array()}};
  for (const auto& [name, version] : versions(build)) json["versions"][name] = version;
  for (const fs::path& directory : path.directories) {
    json["search_path"].push_back(
        {{"directory", directory.string()}, {"exists", is_present(directory)}});
  }
  for (const PluginReport& r : registry.reports()) {
    Json entry{{"file", r.file.string()}, {"state", to_string(r.state)}, {"name", r.name}};
    if (r.state == PluginReport::State::shadowed) entry["shadowed_by"] = r.reason;
    if (r.state == PluginReport::State::refused)
      entry.update({{"reason", r.reason}, {"fix", r.fix}});
    if (!r.version.empty()) {
      entry.update({{"version", r.version},
                    {"license", r.license},
                    {"author", r.author},
                    {"summary", r.summary}});
    }
    if (!r.abi_tag.empty()) entry["abi_tag"] = r.abi_tag;
    if (r.state == PluginReport::State::loaded) entry["components"] = r.components;
    if (!r.left_out.empty()) entry["left_out"] = r.left_out;
    json["plugins"].push_back(std::move(entry));
  }
  return json_text(json);
}

std::string describe(const PluginReport& r, const Paint& paint) {
  const std::string file = r.file.string();
  switch (r.state) {
    case PluginReport::State::loaded: {
      std::string text = fmt::format("  {}    {}\n              {} {}, {}: {}\n              {}\n",
                                     paint.green("loaded"), file, r.name, r.version, r.license,
                                     r.summary, fmt::join(r.components, ", "));
      for (const std::string& component : r.left_out)
        text += fmt::format("              {}: {}\n", paint.red("left out"), component);
      return text;
    }
    case PluginReport::State::shadowed:
      return fmt::format("  {}  {}\n              {} {}, by {}\n", paint.yellow("shadowed"), file,
                         r.name, r.version, r.reason);
    case PluginReport::State::refused:
      return fmt::format("  {}   {}\n              why: {}\n              fix: {}\n",
                         paint.red("refused"), file, r.reason, r.fix);
  }
  return "";
}

std::string as_text(const BuildInfo& build, const SearchPath& path, const Registry& registry) {
  const Paint paint(stdout);
  std::string text = paint.bold("Versions") + "\n";
  for (const auto& [name, version] : versions(build))
    text += fmt::format("  {:<14}{}\n", name, version);
  text += fmt::format("  {:<14}{}\n", "ABI tag", build.abi_tag);
  text += paint.bold("Search path") + "\n";
  for (const fs::path& directory : path.directories) {
    text += fmt::format("  {}{}\n", directory.string(),
                        is_present(directory) ? "" : " (does not exist)");
  }
  text += paint.bold("Plugins") + "\n";
  for (const PluginReport& report : registry.reports()) text += describe(report, paint);
  if (registry.reports().empty()) text += "  none was found\n";
  return text;
}

Exit doctor(const Program& program, bool json) {
  const BuildInfo build = build_info();
  const SearchPath path = default_search_path(program.plugins);
  Registry registry;
  registry.load(path);
  print(json ? as_json(build, path, registry) : as_text(build, path, registry));
  const auto& reports = registry.reports();
  const auto refused = std::count_if(reports.begin(), reports.end(), [](const PluginReport& r) {
    return r.state == PluginReport::State::refused;
  });
  const bool complete = std::all_of(reports.begin(), reports.end(),
                                    [](const PluginReport& r) { return r.left_out.empty(); });
  if (refused > 0)
    complain(fmt::format("{} of {} plugin files {} refused", refused, reports.size(),
                         refused == 1 ? "was" : "were"));
  if (!complete)
    complain(
        "components were left out whose names are there twice; rename them, or remove a plugin");
  return refused == 0 && complete ? Exit::done : Exit::plugin;
}

}  // namespace

CORDON_COMMAND(doctor) {
  CLI::App* command = app.add_subcommand(
      "doctor", "Show versions, the search path, and what became of every plugin found");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Print JSON for programs");
  command->callback([&program, json] { program.exit = doctor(program, *json); });
}

}  // namespace cordon::apps
