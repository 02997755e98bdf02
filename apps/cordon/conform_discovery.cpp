// SPDX-License-Identifier: GPL-3.0-or-later
// Plugins tried in a child process: what they offer, and whether a backend can be made.
#include "conform_discovery.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common.hpp"
#include "conform_backend.hpp"
#include "conform_child.hpp"

namespace cordon::apps {

namespace {

using Json = nlohmann::ordered_json;

/// The ways of rounding that a backend offers, unless the parameters choose one.
std::vector<std::string> roundings(const ParamSchema& schema, const Json& params) {
  const ParamSpec* spec = schema.find("rounding");
  if (!spec || spec->kind != ParamKind::choice || params.contains("rounding")) return {};
  return spec->choices;
}

void discover_in_child(int fd, const std::filesystem::path& library, const std::string& backend,
                       const std::string& params) {
  try {
    Registry registry;
    load_only(registry, library);
    const PluginReport& report = registry.reports().back();
    Json message{
        {"plugin", report.name}, {"version", report.version}, {"candidates", Json::array()}};
    std::vector<std::string> names = registry.names("backend");
    if (!backend.empty()) {
      if (!registry.info("backend", backend)) {
        const std::string suggestion = names.empty() ? "it has none" : suggest(backend, names);
        throw Error(Errc::invalid, fmt::format("{} has no backend \"{}\"; {}", library.string(),
                                               backend, suggestion));
      }
      names = {backend};
    }
    for (const std::string& name : names) {
      const ParamSchema& schema = registry.info("backend", name)->schema;
      params_from(params, schema);
      const Json given = Json::parse(params);
      const auto choices = roundings(schema, given);
      if (choices.empty())
        message["candidates"].push_back({{"backend", name}, {"params", given.dump()}});
      for (const std::string& choice : choices) {
        Json chosen = given;
        chosen["rounding"] = choice;
        message["candidates"].push_back({{"backend", name}, {"params", chosen.dump()}});
      }
    }
    send(fd, message);
  } catch (const Error& error) {
    send(fd, {{"problem", error.what()}, {"invalid", error.code() != Errc::plugin}});
  } catch (...) {
    send(fd, {{"problem", current_text()}, {"invalid", false}});
  }
}

}  // namespace

Discovery discover(const std::filesystem::path& library, const std::string& backend,
                   const std::string& params) {
  Child child([&](int fd) { discover_in_child(fd, library, backend, params); });
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
    found.candidates.push_back({entry.at("backend"), entry.at("params")});
  return found;
}

std::string problem_of_making(const std::filesystem::path& library, const Candidate& candidate) {
  Child child([&](int fd) {
    std::string problem;
    try {
      Registry registry;
      load_only(registry, library);
      registry.make<BackendEntry>(
          candidate.backend,
          params_from(candidate.params, registry.info("backend", candidate.backend)->schema));
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
