// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "cordon/registry/registry.hpp"
#include "registry/temporary.hpp"

using namespace cordon;
using namespace test;

namespace {

class Environment {
 public:
  explicit Environment(const std::string& value) { setenv("CORDON_PLUGIN_PATH", value.c_str(), 1); }
  ~Environment() { unsetenv("CORDON_PLUGIN_PATH"); }
};

const fs::path beside_program =
    fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "lib/cordon/plugins-v1";

}  // namespace

TEST_CASE("the order is: given, environment, beside the program, installed") {
  const TemporaryDirectory given, first, second;
  const Environment environment(first.path().string() + ":" + second.path().string());
  const std::vector<fs::path> extra{given.path()};
  const auto directories = default_search_path(extra).directories;
  REQUIRE(directories.size() == 5);
  CHECK(directories[0] == given.path());
  CHECK(directories[1] == first.path());
  CHECK(directories[2] == second.path());
  CHECK(directories[3] == beside_program);
  CHECK(directories[4].is_absolute());
  CHECK(directories[4].filename() == "plugins-v1");
}

TEST_CASE("without a variable the path holds the two standard directories") {
  CHECK(default_search_path().directories.size() == 2);
}

TEST_CASE("empty entries are no entries: never the working directory implicitly") {
  const TemporaryDirectory directory;
  for (const std::string text : {"", ":", "::", ":::"}) {
    const Environment environment(text);
    CHECK(default_search_path().directories.size() == 2);
  }
  const Environment environment("::" + directory.path().string() + ":");
  const auto directories = default_search_path().directories;
  REQUIRE(directories.size() == 3);
  CHECK(directories[0] == directory.path());
}

TEST_CASE("a directory is searched once, however it is written") {
  const TemporaryDirectory directory;
  fs::create_directory(directory / "a");
  fs::create_directory_symlink(directory / "a", directory / "link");
  const std::string a = (directory / "a").string();
  const Environment environment(a + ":" + a + "/:" + a + "/../a:" + (directory / "link").string());
  CHECK(default_search_path().directories.size() == 3);
}

TEST_CASE(
    "relative directories are made absolute, so that a change of directory does not move them") {
  const Environment environment("plugins/of_mine");
  CHECK(default_search_path().directories[0] == fs::current_path() / "plugins/of_mine");
}

TEST_CASE("the environment variable finds plugins; directories that do not exist are skipped") {
  const TemporaryDirectory directory;
  directory.add(good("test_box"));
  directory.write("readme.txt", "not a plugin");
  directory.write("libother.so.1", "not a plugin");
  const Environment environment("/nowhere/at/all:" + directory.path().string());
  Registry registry;
  SearchPath path = default_search_path();
  path.directories.resize(2);
  registry.load(path);
  REQUIRE(registry.reports().size() == 1);
  CHECK(registry.reports()[0].file == directory / "test_box.so");
  CHECK(registry.reports()[0].state == PluginReport::State::loaded);
}

TEST_CASE("the first plugin of a name wins, the later ones are shadowed by it") {
  const TemporaryDirectory first, second;
  const fs::path winner = first.add(good("test_box"), "z.so"),
                 loser = second.add(good("test_box"), "a.so");
  Registry registry;
  registry.load({{first.path(), second.path()}});
  REQUIRE(registry.reports().size() == 2);
  CHECK(report_of(registry, winner)->state == PluginReport::State::loaded);
  CHECK(report_of(registry, loser)->state == PluginReport::State::shadowed);
  CHECK(report_of(registry, loser)->reason == winner.string());
  CHECK(is_mapped(winner));
  CHECK_FALSE(is_mapped(loser));
}

TEST_CASE("a refused plugin shadows nothing") {
  const TemporaryDirectory first, second;
  const fs::path broken = first.write("test_box.so", "broken"),
                 whole = second.add(good("test_box"));
  Registry registry;
  registry.load({{first.path(), second.path()}});
  CHECK(report_of(registry, broken)->state == PluginReport::State::refused);
  CHECK(report_of(registry, whole)->state == PluginReport::State::loaded);
  CHECK(registry.make<BackendEntry>("test_box", {})->info().name == "test_box");
}

TEST_CASE("what is on the path but no directory is reported") {
  const TemporaryDirectory directory;
  const fs::path file = directory.write("file", "");
  Registry registry;
  registry.load({{file}});
  REQUIRE(registry.reports().size() == 1);
  CHECK(registry.reports()[0].state == PluginReport::State::refused);
  CHECK(registry.reports()[0].file == file);
  CHECK_FALSE(registry.reports()[0].fix.empty());
}
