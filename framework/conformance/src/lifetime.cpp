// SPDX-License-Identifier: GPL-3.0-or-later
// A set keeps what it needs alive, and nothing keeps more.
#include <fstream>

#include "cordon/core/error.hpp"
#include "cordon/registry/registry.hpp"
#include "fingerprint.hpp"

namespace cordon::conformance {

namespace {

TestCase generate_bounded_program(const Setting& s) {
  TestCase test;
  test.sets.push_back(s.make().set("X", 'n', s.n, {false, 5, 1}));
  test.sets.push_back(s.make().set("Y", 'n', s.n, {false, 5, 1}));
  const Index p = s.random.between(1, 2);
  test.matrices.push_back({"A", 'p', 'n', s.make().map(p, s.n)});
  test.vectors.push_back({"f", 'p', s.make().vector(p)});
  return test;
}

/// Results are used after the handles of their operands and of the backend have gone.
Verdict check_outlives(const Context& context, const TestCase& test) {
  auto backend = context.subject.make(context.subject.params);
  std::vector<std::pair<std::string, Enclosure>> results;
  std::vector<std::string> before;
  {
    const Enclosure X = backend->import(test.set(0).form), Y = backend->import(test.set(1).form);
    for (const auto& [name, run] : program(*backend, X, Y, test)) {
      if (const auto result = attempt_operation(run)) {
        results.emplace_back(name, *result);
        before.push_back(fingerprint(**result));
      }
    }
  }
  backend.reset();
  for (std::size_t k = 0; k < results.size(); ++k) {
    const auto& [name, set] = results[k];
    if (const std::string now = fingerprint(*set); now != before[k]) {
      Verdict verdict =
          Verdict::fails("the result of " + name +
                         " is another set when the handles of operands and backend have gone");
      verdict.derived.emplace_back("before", before[k]);
      verdict.derived.emplace_back("after", now);
      return verdict;
    }
    const SetBackend& own = set->backend();
    attempt_operation([&own, &held = set] { return own.sum(held, held); });
  }
  return {};
}

std::optional<std::string> needs_library(const Context& context) {
  if (!context.subject.library.empty() && !context.subject.component.empty()) return std::nullopt;
  return "the backend does not come from a plugin's file";
}

bool is_mapped(const std::filesystem::path& library) {
  std::error_code error;
  const std::string file = std::filesystem::canonical(library, error).string();
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    if (line.ends_with(file)) return true;
  }
  return false;
}

/// What `unload` says: "" for done.
std::string unloaded(Registry& registry, const std::string& plugin) {
  try {
    registry.unload(plugin);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

Verdict check_unload(const Context& context, const TestCase& test) {
  const bool was_mapped = is_mapped(context.subject.library);
  {
    Registry registry;
    const PluginReport report = registry.load_file(context.subject.library);
    if (report.state != PluginReport::State::loaded)
      return Verdict::fails("the plugin was refused: " + report.reason);
    Enclosure last;
    {
      const auto backend =
          registry.make<BackendEntry>(context.subject.component, context.subject.params);
      const Enclosure X = backend->import(test.set(0).form), Y = backend->import(test.set(1).form);
      for (const auto& [name, run] : program(*backend, X, Y, test)) {
        if (const auto result = attempt_operation(run)) last = *result;
      }
      if (!last.set) last = X;
    }
    if (unloaded(registry, report.name).empty())
      return Verdict::fails("the plugin was unloaded while a set of it was alive");
    (void)fingerprint(*last);
    last = {};
    if (const std::string why = unloaded(registry, report.name); !why.empty()) {
      return Verdict::fails(
          "all sets and backends have gone, but the plugin keeps objects of its own: " + why);
    }
  }
  if (!was_mapped && is_mapped(context.subject.library)) {
    return Verdict::fails(
        "the library stays mapped after it was unloaded: a unique symbol or a thread_local object "
        "with a destructor");
  }
  return {};
}

}  // namespace

void add_lifetime(LawList& list) {
  LawEntry outlives{{"lifetime.set_outlives_handle",
                     "a set outlives the handles of its operands, its backend and the registry"},
                    generate_bounded_program,
                    check_outlives,
                    {},
                    0.1};
  LawEntry unload{{"lifetime.unload",
                   "the plugin can be unloaded when its last object has gone, and not before"},
                  generate_bounded_program,
                  check_unload,
                  needs_library,
                  0.05};
  outlives.without_backend = unload.without_backend = true;
  list.push_back(unload);  // before anything else runs in this process
  list.push_back(outlives);
}

}  // namespace cordon::conformance
