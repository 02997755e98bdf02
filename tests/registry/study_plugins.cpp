// SPDX-License-Identifier: GPL-3.0-or-later
// A study may come from anywhere: no command opens plugins from directories that only the study
// names, unless it is told to.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "registry/temporary.hpp"
#include "run/program.hpp"

using namespace test;
using nlohmann::json;

namespace {

/// A study in a directory of its own, with a directory of plugins beside it whose plugin tells when
/// it is opened.
class Received {
 public:
  explicit Received(bool needs_the_plugin) {
    fs::create_directory(directory_ / "plugins");
    fs::copy_file(fs::path(CORDON_TRACING_PLUGINS) / "tracing.so",
                  directory_ / "plugins/tracing.so");
    json study = json::parse(read(CORDON_SOURCE_DIR "/examples/studies/linear_two_states.json"));
    study["plugins"] = {"plugins"};
    if (needs_the_plugin) study["metrics"].push_back("tracing");
    file = directory_.write("study.json", study.dump(2)).string();
  }

  Outcome run(const std::string& arguments, const std::string& environment = "") {
    fs::remove(trace());
    return cordon_with(arguments, environment + " CORDON_TEST_TRACE=" + trace().string());
  }
  bool was_opened() const { return fs::exists(trace()); }
  std::string plugins() const { return (directory_ / "plugins").string(); }
  std::string out() const { return (directory_ / "out").string(); }

  std::string file;

 private:
  fs::path trace() const { return directory_ / "trace"; }
  TemporaryDirectory directory_;
};

}  // namespace

TEST_CASE("validate opens nothing that only the study names, and says what it could not check") {
  Received needed(true);
  const Outcome outcome = needed.run("validate " + needed.file);
  CHECK(outcome.code == 3);
  CHECK_FALSE(needed.was_opened());
  CHECK_MESSAGE(contains(outcome.err, "/metrics/"), outcome.err);
  CHECK(contains(outcome.err, "no metric \"tracing\""));
  CHECK(contains(
      outcome.err,
      needed.plugins() +
          "/tracing.so was refused: it was not opened and nothing of it is checked, since only "
          "the study names its directory"));
  CHECK(contains(outcome.err,
                 "give --trust-plugins, or that directory by --plugins or CORDON_PLUGIN_PATH"));
  CHECK(json::parse(needed.run("validate --json " + needed.file).out)
            .at("studies")
            .at(0)
            .at("valid") == false);

  Received not_needed(false);
  const Outcome fine = not_needed.run("validate " + not_needed.file);
  CHECK(fine.code == 0);
  CHECK_FALSE(not_needed.was_opened());
  CHECK_MESSAGE(contains(fine.err, "warning: plugin " + not_needed.plugins() +
                                       "/tracing.so was refused: it was not opened"),
                fine.err);
}

TEST_CASE("commands that need the whole study ask for trust, and write nothing") {
  for (const bool needs : {true, false}) {
    Received study(needs);
    for (const std::string& command :
         {"run " + study.file + " --out " + study.out(), "guarantees " + study.file,
          "design " + study.file, "convert " + study.file + " " + study.out() + ".mat"}) {
      const Outcome outcome = study.run(command);
      INFO(command, ": ", outcome.err);
      CHECK(outcome.code == 3);
      CHECK(contains(outcome.err, "/plugins/0 (line "));
      CHECK(contains(outcome.err,
                     "plugins are programs, and only the study names this directory of them"));
      CHECK(contains(outcome.err,
                     "if you trust what is in \"" + study.plugins() + "\", give --trust-plugins"));
      CHECK_FALSE(study.was_opened());
      CHECK_FALSE(fs::exists(study.out()));
    }
  }
}

TEST_CASE("a directory is trusted by the option, or as a part of the search path") {
  Received study(true);
  const std::string run = "run --quiet " + study.file + " --out " + study.out();
  for (const auto& [arguments, environment] :
       {std::pair<std::string, std::string>{"--trust-plugins ", ""},
        {"--plugins " + study.plugins() + "/../plugins ", ""},
        {"", "CORDON_PLUGIN_PATH=/nowhere:" + study.plugins()}}) {
    for (const std::string& command : {run, "validate " + study.file}) {
      const Outcome outcome = study.run(arguments + command, environment);
      CHECK_MESSAGE(outcome.code == 0, outcome.err);
      CHECK(study.was_opened());
      CHECK(outcome.err.empty());
    }
  }
}

TEST_CASE("trust in one directory is no trust in its neighbour") {
  Received study(true), other(true);
  CHECK(study.run("--plugins " + other.plugins() + " run " + study.file + " --out " + study.out())
            .code == 3);
  CHECK_FALSE(fs::exists(study.out()));
}
