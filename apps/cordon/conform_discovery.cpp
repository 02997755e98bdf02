// SPDX-License-Identifier: GPL-3.0-or-later
// Plugins tried in a child process: what they offer, and whether a backend can be made.
#include "conform_discovery.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common.hpp"
#include "conform_child.hpp"
#include "conform_component.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;

/// The ways of rounding that a backend offers, unless the parameters choose one.
std::vector<std::string> roundings(const ParamSchema& schema, const Json& params) {
  const ParamSpec* spec = schema.find("rounding");
  if (!spec || spec->kind != ParamKind::choice || params.contains("rounding")) return {};
  return spec->choices;
}

/// The names of the kind that are wanted.
std::vector<std::string> wanted_names(const Registry& registry, const std::string& kind,
                                      const Wanted& wanted) {
  if (!wanted.kind.empty() && wanted.kind != kind) return {};
  if (wanted.component.empty()) return registry.names(kind);
  if (!registry.info(kind, wanted.component)) return {};
  return {wanted.component};
}

/// None is there: what there is instead.
[[noreturn]] void refuse_wanted(const Registry& registry, const std::filesystem::path& library,
                                const Wanted& wanted) {
  const auto& kinds = Registry::kinds();
  if (!wanted.kind.empty() && std::find(kinds.begin(), kinds.end(), wanted.kind) == kinds.end()) {
    throw Error(Errc::invalid, fmt::format("there is no kind \"{}\"; {}", wanted.kind,
                                           suggest(wanted.kind, kinds)));
  }
  std::vector<std::string> names;
  for (const std::string& kind : kinds) {
    if (!wanted.kind.empty() && kind != wanted.kind) continue;
    for (const std::string& name : registry.names(kind)) names.push_back(name);
  }
  const std::string what = wanted.kind.empty() ? "component" : wanted.kind;
  if (wanted.component.empty())
    throw Error(Errc::invalid, fmt::format("{} has no {}", library.string(), what));
  throw Error(Errc::invalid,
              fmt::format("{} has no {} \"{}\"; {}", library.string(), what, wanted.component,
                          names.empty() ? "it has none" : suggest(wanted.component, names)));
}

void discover_in_child(int fd, const std::filesystem::path& library, const Wanted& wanted) {
  try {
    Registry registry;
    load_only(registry, library);
    const PluginReport& report = registry.reports().back();
    Json message{
        {"plugin", report.name}, {"version", report.version}, {"candidates", Json::array()}};
    for (const std::string& kind : Registry::kinds()) {
      for (const std::string& name : wanted_names(registry, kind, wanted)) {
        const ParamSchema& schema = registry.info(kind, name)->schema;
        const bool is_backend = kind == BackendEntry::kind;
        params_from(wanted.params, schema, is_backend);
        const Json given = Json::parse(wanted.params);
        const auto choices = is_backend ? roundings(schema, given) : std::vector<std::string>{};
        Json candidate{{"kind", kind}, {"component", name}, {"params", given.dump()}};
        if (choices.empty()) message["candidates"].push_back(candidate);
        for (const std::string& choice : choices) {
          Json chosen = given;
          chosen["rounding"] = choice;
          candidate["params"] = chosen.dump();
          message["candidates"].push_back(candidate);
        }
      }
    }
    if (message["candidates"].empty()) refuse_wanted(registry, library, wanted);
    send(fd, message);
  } catch (const Error& error) {
    send(fd, {{"problem", error.what()}, {"invalid", error.code() != Errc::plugin}});
  } catch (...) {
    send(fd, {{"problem", current_text()}, {"invalid", false}});
  }
}

}  // namespace

Discovery discover(const std::filesystem::path& library, const Wanted& wanted) {
  Child child([&](int fd) { discover_in_child(fd, library, wanted); });
  Discovery found;
  Json message;
  switch (child.wait(60, message)) {
    case Child::Event::timeout:
      child.kill_now();
      found.problem =
          fmt::format("{} does not come back from being loaded within 60 s", library.string());
      return found;
    case Child::Event::ended: {
      const std::string how = child.finish();
      found.problem = fmt::format("{} ends the process while it is loaded: {}", library.string(),
                                  how.empty() ? "exit code 0" : how);
      return found;
    }
    case Child::Event::message:
      break;
  }
  if (message.contains("problem")) {
    found.problem = message.at("problem");
    found.invalid = message.at("invalid");
    return found;
  }
  found.plugin = message.at("plugin");
  found.version = message.at("version");
  for (const Json& entry : message.at("candidates"))
    found.candidates.push_back({entry.at("kind"), entry.at("component"), entry.at("params")});
  return found;
}

std::string problem_of_making(const std::filesystem::path& library, const Candidate& candidate) {
  if (candidate.kind != BackendEntry::kind) return "";
  Child child([&](int fd) {
    std::string problem;
    try {
      Registry registry;
      load_only(registry, library);
      registry.make<BackendEntry>(
          candidate.component,
          params_from(candidate.params, registry.info("backend", candidate.component)->schema,
                      true));
    } catch (...) {
      problem = current_text();
    }
    send(fd, {{"problem", problem}});
  });
  Json message;
  switch (child.wait(60, message)) {
    case Child::Event::message:
      return message.at("problem");
    case Child::Event::timeout:
      child.kill_now();
      return "making it does not end within 60 s";
    case Child::Event::ended:
      break;
  }
  const std::string how = child.finish();
  return "making it ends the process: " + (how.empty() ? "exit code 0" : how);
}

}  // namespace cordon::apps
