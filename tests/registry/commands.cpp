// SPDX-License-Identifier: GPL-3.0-or-later
// The commands list, info and doctor as a user meets them: output, exit codes, closed pipes.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "registry/temporary.hpp"
#include "run/program.hpp"

using namespace test;
using nlohmann::json;

namespace {

const std::string with_good = "--plugins \"" CORDON_GOOD_PLUGINS "\" ",
                  with_bad = "--plugins \"" CORDON_BAD_PLUGINS "\" ";

const json* entry(const json& entries, const char* key, const std::string& value) {
  for (const json& candidate : entries) {
    if (candidate.at(key) == value) return &candidate;
  }
  return nullptr;
}

}  // namespace

TEST_CASE("list shows every component with kind, plugin and summary") {
  const Outcome text = cordon_with("list " + with_good);
  CHECK(text.code == 0);
  CHECK(contains(text.out, "axis-aligned boxes for tests"));
  CHECK_FALSE(contains(text.out, "\x1b"));
  const Outcome machine = cordon_with("list --json " + with_good);
  CHECK(machine.code == 0);
  const json components = json::parse(machine.out).at("components");
  const json* box = entry(components, "name", "test_box");
  REQUIRE(box);
  CHECK(box->at("kind") == "backend");
  CHECK(box->at("plugin") == "test_box");
  REQUIRE(entry(components, "name", "open_loop"));
  CHECK(entry(components, "name", "open_loop")->at("kind") == "observer");
}

TEST_CASE("list warns about refused plugins and goes on") {
  const Outcome outcome = cordon_with(with_good + with_bad + "list");
  CHECK(outcome.code == 0);
  CHECK(contains(outcome.out, "test_box"));
  CHECK(contains(outcome.err, "warning: " CORDON_BAD_PLUGINS "/wrong_tag.so was refused: "));
  CHECK_FALSE(contains(outcome.out, "warning"));
}

TEST_CASE("info explains the parameters") {
  const Outcome text = cordon_with("info " + with_good + "test_box");
  CHECK(text.code == 0);
  CHECK(contains(text.out, "backend test_box (plugin test_box)"));
  CHECK(contains(text.out,
                 "growth     real  0        [0, 1]  relative growth of every imported box"));
  CHECK(contains(cordon_with("info open_loop " + with_good).out, "It takes no parameters."));
  const Outcome machine = cordon_with("info test_box --json " + with_good);
  const json params = json::parse(machine.out).at("components").at(0).at("params");
  CHECK(
      params ==
      json::parse(
          R"([{"name": "growth", "type": "real", "required": false, "default": 0.0, "lowest": 0.0, "highest": 1.0,
                                    "doc": "relative growth of every imported box, dimensionless"}])"));
}

TEST_CASE(
    "info about an unknown component is invalid input with a suggestion; about a refused one, a "
    "plugin's failure") {
  const Outcome unknown = cordon_with("info tst_box " + with_good);
  CHECK(unknown.code == 2);
  CHECK(unknown.err == "error: no component \"tst_box\"; did you mean \"test_box\"?\n");
  CHECK(unknown.out.empty());
  const TemporaryDirectory directory;
  const fs::path file = directory.write("zonotope_of_mine.so", "text");
  const Outcome refused =
      cordon_with("info zonotope_of_mine --plugins " + directory.path().string());
  CHECK(refused.code == 3);
  CHECK(contains(refused.err, file.string() + " was refused: it is not a shared library"));
}

TEST_CASE("doctor tells what became of every library, and returns 3 if any was refused") {
  const Outcome text = cordon_with(with_good + with_bad + "doctor");
  CHECK(text.code == 3);
  CHECK(contains(text.err, "plugin files were refused"));
  for (const char* part :
       {"loaded    " CORDON_GOOD_PLUGINS "/test_box.so",
        "shadowed  " CORDON_BAD_PLUGINS "/repeats_plugin.so",
        "by " CORDON_GOOD_PLUGINS "/test_box.so",
        "refused   " CORDON_BAD_PLUGINS "/wrong_version.so",
        "why: it was built for plugin ABI 4, this is 3", "fix: rebuild the plugin", "gxx_abi="}) {
    CHECK_MESSAGE(contains(text.out, part), part);
  }
  const Outcome machine = cordon_with(with_good + with_bad + "doctor --json");
  CHECK(machine.code == 3);
  const json report = json::parse(machine.out);
  CHECK(report.at("search_path").at(0) ==
        json{{"directory", CORDON_GOOD_PLUGINS}, {"exists", true}});
  for (const char* tool : {"cordon", "compiler", "eigen", "boost", "nlohmann_json", "cddlib"})
    CHECK(report.at("versions").contains(tool));
  const json* refused = entry(report.at("plugins"), "file", CORDON_BAD_PLUGINS "/unresolved.so");
  REQUIRE(refused);
  CHECK(refused->at("state") == "refused");
  CHECK(contains(refused->at("reason"), "cordon_test_function_that_is_nowhere"));
  CHECK_FALSE(refused->at("fix").get<std::string>().empty());
  const json* shadowed =
      entry(report.at("plugins"), "file", CORDON_BAD_PLUGINS "/repeats_plugin.so");
  REQUIRE(shadowed);
  CHECK(shadowed->at("shadowed_by") == CORDON_GOOD_PLUGINS "/test_box.so");
}

TEST_CASE("doctor returns 0 when nothing was refused, and the environment variable is heard") {
  const Outcome outcome = cordon_with("doctor", "CORDON_PLUGIN_PATH=\"" CORDON_GOOD_PLUGINS "\"");
  CHECK(outcome.code == 0);
  CHECK(outcome.err.empty());
  CHECK(contains(outcome.out, "loaded    " CORDON_GOOD_PLUGINS "/test_box.so"));
}

TEST_CASE("a working plugin is tried in every process, with any cache or none") {
  const TemporaryDirectory cache, plugins;
  plugins.add(fs::path(CORDON_TRACING_PLUGINS) / "tracing.so");
  const std::string trace = (cache / "trace").string(),
                    list = "list --plugins " + plugins.path().string();
  for (const std::string& place :
       {cache.path().string(), cache.path().string(), std::string("/proc/nowhere"),
        std::string("/dev/null"), std::string("relative HOME=")}) {
    fs::remove(trace);
    const Outcome outcome =
        cordon_with(list, "CORDON_TEST_TRACE=" + trace + " XDG_CACHE_HOME=" + place);
    CHECK(outcome.code == 0);
    CHECK(contains(outcome.out, "tracing"));
    CHECK(outcome.err.empty());
    const std::string text = read(trace);
    CHECK(std::count(text.begin(), text.end(), '\n') == 2);
  }
  CHECK_FALSE(fs::exists("relative"));
}

TEST_CASE("a refusal by trial is kept in the cache") {
  const TemporaryDirectory cache, plugins;
  plugins.add(bad("ends_the_process"));
  const auto told = [&](const std::string& text) {
    const std::string list = "list --plugins " + plugins.path().string();
    return contains(cordon_with(list, "XDG_CACHE_HOME=" + cache.path().string()).err, text);
  };
  const auto rewrite = [&](auto&& change) {
    for (const auto& entry : fs::directory_iterator(cache / "cordon/plugins")) {
      CHECK_FALSE(entry.path().filename().string().starts_with("."));
      std::string text = read(entry.path());
      change(text);
      std::ofstream(entry.path(), std::ios::binary) << text;
    }
  };
  CHECK(told("when it is opened: exit code 0"));
  rewrite([](std::string& text) {
    if (const auto at = text.find("exit code 0"); at != std::string::npos)
      text.replace(at, 11, "as remembered");
  });
  CHECK(told("when it is opened: as remembered"));
  rewrite([](std::string& text) { text = "no entry at all\n"; });
  CHECK(told("when it is opened: exit code 0"));
  std::ofstream(plugins / "ends_the_process.so", std::ios::binary | std::ios::app)
      << "behind its end";
  CHECK(told("when it is opened: exit code 0"));
}

TEST_CASE("a component whose name is taken is named, and makes doctor's exit code") {
  const std::string text = "metric \"step_count\" is there already, from plugin \"test_box\"";
  const TemporaryDirectory directory;
  directory.add(bad("repeats_component"));
  const std::string both = with_good + "--plugins " + directory.path().string() + " ";
  const Outcome list = cordon_with(both + "list");
  CHECK(list.code == 0);
  CHECK(contains(list.err,
                 "warning: " + (directory / "repeats_component.so").string() + ": " + text));
  CHECK(contains(list.out, "new_in_repeats_component"));
  const Outcome doctor = cordon_with(both + "doctor");
  CHECK(doctor.code == 3);
  CHECK(contains(doctor.out, "left out: " + text));
  const json report = json::parse(cordon_with(both + "doctor --json").out);
  const json* plugin = entry(report.at("plugins"), "name", "repeats_component");
  REQUIRE(plugin);
  CHECK(plugin->at("state") == "loaded");
  CHECK(plugin->at("left_out") == json{text});
}

TEST_CASE("usage errors are invalid input; help and version are not") {
  CHECK(cordon_with("").code == 2);
  const Outcome typo = cordon_with("lst");
  CHECK(typo.code == 2);
  CHECK(typo.err == "error: no command \"lst\"; did you mean \"list\"?\n");
  CHECK(cordon_with("list --no-such-option").code == 2);
  CHECK(cordon_with("info").code == 0);
  const Outcome missing = cordon_with("list --plugins /nowhere/at/all");
  CHECK(missing.code == 2);
  CHECK(contains(missing.err, "/nowhere/at/all"));
  const Outcome help = cordon_with("--help");
  CHECK(help.code == 0);
  CHECK(help.err.empty());
  CHECK(contains(help.out, "3    a plugin that is needed was refused, or failed"));
  const Outcome version = cordon_with("--version");
  CHECK(version.code == 0);
  CHECK(contains(version.out, "cordon "));
}

TEST_CASE("a reader that leaves is no error; a full disk is") {
  const std::string code = " ; echo $? > ";
  const TemporaryDirectory directory;
  const std::string file = (directory / "code").string();
  // the reader has closed its end before the program writes
  cordon_with("doctor --json" + code + file + " ) | ( exec <&-", "sleep 0.3;");
  CHECK(read(file) == "0\n");
  const Outcome full = cordon_with("doctor > /dev/full");
  CHECK(full.code == 2);
  CHECK(contains(full.err, "cannot write to standard output"));
}

TEST_CASE("colours only on a terminal") {
  const std::string script = "script -qec '\"" CORDON_PROGRAM "\" doctor' /dev/null";
  if (std::system("command -v script > /dev/null") != 0) return;  // no pseudo-terminal to be had
  const TemporaryDirectory directory;
  const auto output = [&](const std::string& environment) {
    REQUIRE(std::system(
                (environment + " " + script + " > " + (directory / "out").string() + " < /dev/null")
                    .c_str()) == 0);
    return read(directory / "out");
  };
  CHECK(contains(output("NO_COLOR= TERM=xterm"), "\x1b[1mVersions"));
  CHECK_FALSE(contains(output("NO_COLOR=1 TERM=xterm"), "\x1b"));
  CHECK_FALSE(contains(output("NO_COLOR= TERM=dumb"), "\x1b"));
}
