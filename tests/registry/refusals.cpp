// SPDX-License-Identifier: GPL-3.0-or-later
// Deliberately bad plugins: each is refused with file, reason and fix, leaves nothing, and the good
// ones work on.
#include <sys/stat.h>

#include <doctest/doctest.h>

#include "cordon/registry/registry.hpp"
#include "registry/temporary.hpp"

using namespace cordon;
using namespace test;

namespace {

const PluginReport& refused(Registry& registry, const fs::path& file, const std::string& reason,
                            const std::string& fix) {
  const PluginReport& report = registry.load_file(file);
  INFO(file.string(), ": ", report.reason, " / ", report.fix);
  CHECK(report.state == PluginReport::State::refused);
  CHECK(report.file == file);
  CHECK(report.reason.find(reason) != std::string::npos);
  CHECK(report.fix.find(fix) != std::string::npos);
  return report;
}

/// Only the good plugin's components are there, and they work.
void check_unharmed(const Registry& registry) {
  CHECK(registry.names("backend") == std::vector<std::string>{"test_box"});
  CHECK(registry.names("observer") == std::vector<std::string>{"open_loop"});
  CHECK(registry.names("metric") == std::vector<std::string>{"step_count"});
  const auto backend = registry.make<BackendEntry>("test_box", {});
  CHECK(backend->import(make_point(Vector::Ones(2)))->dim() == 2);
}

struct BadPlugin {
  const char *name, *reason, *fix;
};

const BadPlugin bad_plugins[] = {
    {"bad_name", "metric \"CamelCase\" is not in snake_case", "repair what the plugin registers"},
    {"contradictory", "parameter \"size\" has a default that is 11, must lie in [0, 10]",
     "A. Uthor"},
    {"control_characters", "the text \"summary\" of its descriptor is damaged", "rebuild"},
    {"crashes",
     "it ends the process when it is opened: ", "it is tried again when the file changes"},
    {"damaged_text", "a metric has a summary of 1152921504606846976 bytes",
     "repair what the plugin registers"},
    {"empty_string", "its descriptor lacks author", "fill in every field"},
    {"ends_the_process", "it ends the process when it is opened: exit code 0",
     "repair or remove it"},
    {"fast_math", "fast_math: 1 in the plugin, 0 here",
     "rebuild the plugin with this installation's headers and flags"},
    {"flushes_subnormals",
     "changes the floating-point arithmetic of the whole process when it is opened: subnormal "
     "numbers become zero",
     "link it without -ffast-math"},
    {"grows",
     "it ends the process when it is opened: exit code 1; it said: ", "repair or remove it"},
    {"no_creator", "metric \"without_creator\" has no function that makes it",
     "repair what the plugin registers"},
    {"no_descriptor", "exports no symbol cordon_plugin_descriptor", "cordon_add_plugin"},
    {"no_summary", "metric \"without_summary\" has no summary", "repair what the plugin registers"},
    {"registers_nothing", "its descriptor lacks register_components", "fill in every field"},
    {"repeats_itself", "metric \"twice\" is registered twice", "repair what the plugin registers"},
    {"rounds_down",
     "changes the floating-point arithmetic of the whole process when it is opened: its rounding "
     "or its traps",
     "leave the floating-point environment alone"},
    {"throws_at_once",
     "signal 6 (Aborted); it said: terminate called after throwing an instance of "
     "'std::runtime_error' what(): no "
     "room for static objects",
     "repair or remove it"},
    {"throws_int", "threw something that is no std::exception while registering", "A. Uthor"},
    {"throws_late", "threw while registering: no licence server", "A. Uthor"},
    {"undocumented",
     "parameter \"quiet\" of metric \"with_undocumented_parameter\" is not documented",
     "repair what the plugin registers"},
    {"unresolved", "cordon_test_function_that_is_nowhere", "with every library it needs"},
    {"uses_leftovers", "it ends the process when it is opened: ", "repair or remove it"},
    {"wrong_size", "its descriptor has 1096 bytes, must have 1104",
     "rebuild the plugin with this installation's headers and flags"},
    {"wrong_tag", "simd: avx2 in the plugin, absent here",
     "rebuild the plugin with this installation's headers and flags"},
    {"wrong_version", "it was built for plugin ABI 4, this is 3",
     "rebuild the plugin with this installation's headers and flags"},
#if defined(CORDON_SANITIZED_PLUGINS)
    {"linked_with_sanitizer", "exit code 1; it said: ==", "repair or remove it"},
    {"with_sanitizer", "asan: 1 in the plugin, 0 here",
     "rebuild the plugin with this installation's headers and flags"},
#endif
};

}  // namespace

TEST_CASE("bad plugins are refused with reason and fix, leave nothing, and are closed again") {
  Registry registry;
  registry.load_file(good("test_box"));
  for (const BadPlugin& plugin : bad_plugins) {
    refused(registry, bad(plugin.name), plugin.reason, plugin.fix);
    check_unharmed(registry);
    CHECK_FALSE(is_mapped(bad(plugin.name)));
  }
}

TEST_CASE("a whole directory of bad plugins does not keep the good one from loading") {
  Registry registry;
  registry.load({{CORDON_BAD_PLUGINS, CORDON_GOOD_PLUGINS}});
  // here step_count and the name test_box were taken by the first ones; they are then the
  // legitimate ones
  std::size_t refusals = 0;
  for (const PluginReport& report : registry.reports()) {
    if (report.state != PluginReport::State::refused) continue;
    ++refusals;
    CHECK_FALSE(report.reason.empty());
    CHECK_FALSE(report.fix.empty());
  }
  CHECK(refusals == std::size(bad_plugins));
  REQUIRE(report_of(registry, bad("repeats_plugin")));
  CHECK(report_of(registry, bad("repeats_plugin"))->state == PluginReport::State::loaded);
  REQUIRE(report_of(registry, good("test_box")));
  CHECK(report_of(registry, good("test_box"))->state == PluginReport::State::shadowed);
  CHECK(report_of(registry, good("test_faults"))->state == PluginReport::State::loaded);
}

TEST_CASE("a component whose name is taken is left out, and the rest of its plugin works") {
  Registry registry;
  registry.load_file(good("test_box"));
  const PluginReport& report = registry.load_file(bad("repeats_component"));
  CHECK_MESSAGE(report.state == PluginReport::State::loaded, report.reason);
  CHECK(report.components == std::vector<std::string>{"metric new_in_repeats_component"});
  CHECK(report.left_out == std::vector<std::string>{
                               "metric \"step_count\" is there already, from plugin \"test_box\""});
  CHECK(registry.plugin_of("metric", "step_count") == "test_box");
  CHECK(registry.plugin_of("metric", "new_in_repeats_component") == "repeats_component");
  CHECK(registry.make<MetricEntry>("new_in_repeats_component", {}));
  registry.unload("repeats_component");
  check_unharmed(registry);
}

TEST_CASE("two plugins of one name in one directory contradict each other") {
  const TemporaryDirectory directory;
  const fs::path first = directory.add(good("test_box"), "a.so"),
                 second = directory.add(bad("repeats_plugin"), "b.so");
  Registry registry;
  registry.load({{directory.path()}});
  CHECK(report_of(registry, first)->state == PluginReport::State::loaded);
  refused(registry, second,
          first.string() + " in the same directory has the same plugin name \"test_box\"",
          "remove one of the two");
  check_unharmed(registry);
}

TEST_CASE("what is no library at all is refused before the loader sees it") {
  const TemporaryDirectory directory;
  Registry registry;
  registry.load_file(good("test_box"));
  fs::create_directory(directory / "directory.so");
  fs::create_symlink(directory / "nowhere", directory / "dangling.so");
  fs::create_symlink(directory / "circle.so", directory / "circle.so");
  REQUIRE(mkfifo((directory / "pipe.so").c_str(), 0600) == 0);
  refused(registry, directory.write("text.so", "# hello\n"), "not a shared library (no ELF file)",
          "move it out");
  refused(registry, directory.write("empty.so", ""), "it is empty", "again");
  refused(registry,
          directory.write("short.so",
                          "\x7f"
                          "EL"),
          "not a shared library", "move it out");
  refused(registry,
          directory.write("magic.so",
                          "\x7f"
                          "ELF"),
          "truncated", "again");
  refused(registry, directory / "directory.so", "is a directory", "remove");
  refused(registry, directory / "dangling.so",
          "symbolic link to \"" + (directory / "nowhere").string(), "link");
  refused(registry, directory / "circle.so", "", "");
  refused(registry, directory / "pipe.so", "not a regular file", "remove");
  refused(registry, directory / "missing.so", "there is no such file", "check the path");
  refused(registry, "/proc/self/exe", "", "");
  check_unharmed(registry);
}

TEST_CASE("libraries of other machines and objects that are no libraries are refused") {
  const TemporaryDirectory directory;
  Registry registry;
  const std::string bytes = read(good("test_box"));
  const auto changed = [&](const char* name, std::size_t at, char byte) {
    std::string copy = bytes;
    copy[at] = byte;
    return directory.write(name, copy);
  };
  refused(registry, changed("other_class.so", 4, 1), "word size", "this machine");
  refused(registry, changed("other_order.so", 5, 2), "another processor", "this machine");
  refused(registry, changed("other_machine.so", 18, '\x08'), "another processor", "this machine");
  refused(registry, changed("relocatable.so", 16, 1), "no shared library", "move it out");
}

TEST_CASE("a truncated library is refused at every length") {
  const TemporaryDirectory directory;
  const std::string bytes = read(good("test_box"));
  Registry registry;
  std::vector<std::size_t> lengths;
  for (std::size_t n = 0; n < 1100; n += 10) lengths.push_back(n);  // in the headers
  for (std::size_t n = 1100; n < bytes.size(); n += 4089 + bytes.size() / 64)
    lengths.push_back(n);  // in the segments
  for (std::size_t n = 1; n < 2000; n += 11)
    lengths.push_back(bytes.size() - n);  // in the tables at the end
  for (const std::size_t length : lengths) {
    const PluginReport& report =
        registry.load_file(directory.write("test_box.so", bytes.substr(0, length)));
    REQUIRE_MESSAGE(report.state == PluginReport::State::refused, "cut to ", length, " of ",
                    bytes.size(), " bytes");
    REQUIRE_FALSE(report.fix.empty());
  }
  CHECK(registry.load_file(directory.write("test_box.so", bytes)).state ==
        PluginReport::State::loaded);
}

TEST_CASE("the refused plugin that held a component is found") {
  const TemporaryDirectory directory;
  Registry registry;
  registry.load_file(good("test_box"));
  CHECK(registry.refused_provider("zonotope") == nullptr);
  registry.load_file(directory.write("zonotope.so", "text"));
  registry.load_file(bad("throws_late"));
  registry.load_file(bad("wrong_tag"));
  const auto file_of = [&](const char* component) {
    const PluginReport* report = registry.refused_provider(component);
    return report ? report->file : fs::path();
  };
  CHECK(file_of("zonotope") == directory / "zonotope.so");   // by its file
  CHECK(file_of("before_the_throw") == bad("throws_late"));  // by what it was about to register
  CHECK(file_of("wrong_tag") == bad("wrong_tag"));
  CHECK(file_of("zonotop") == fs::path());
  CHECK(file_of("") == fs::path());
  registry.load_file(directory.write("estimators.so",
                                     std::string("cordon_plugin_descriptor\0tube_observer\0", 38)));
  CHECK(file_of("tube_observer") == directory / "estimators.so");  // by a word of the file
  CHECK(file_of("tube") == fs::path());
  CHECK(file_of("descriptor") == fs::path());
  try {
    registry.make<BackendEntry>("zonotope", {});
    FAIL("made a backend of a refused plugin");
  } catch (const Error& error) {
    CHECK(error.code() == Errc::plugin);
    for (const std::string& part : {(directory / "zonotope.so").string(),
                                    std::string("no ELF file"), std::string("move it out")}) {
      CHECK(std::string(error.what()).find(part) != std::string::npos);
    }
  }
}

TEST_CASE("a library that is announced but missing is named, with its components") {
  const TemporaryDirectory directory;
  std::ofstream(directory / "gone.provides") << "backend gone_box\nobserver gone_observer\n";
  std::ofstream(directory / "broken.provides") << "backend broken_box\n";
  std::ofstream(directory / "broken.so") << "no library\n";
  Registry registry;
  registry.load({{directory.path()}});
  const PluginReport* gone = registry.refused_provider("gone_observer");
  REQUIRE(gone);
  CHECK(gone->file == directory / "gone.so");
  CHECK(gone->reason.find("missing") != std::string::npos);
  CHECK_FALSE(gone->fix.empty());
  const PluginReport* broken = registry.refused_provider("broken_box");
  REQUIRE(broken);
  CHECK(broken->file == directory / "broken.so");
  CHECK_FALSE(registry.refused_provider("another_box"));
}
