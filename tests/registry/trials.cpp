// SPDX-License-Identifier: GPL-3.0-or-later
// No code runs before the file was accepted, and then in a child process first; what is seen there
// is remembered.
#include <atomic>
#include <cfenv>
#include <cstdlib>
#include <limits>
#include <thread>

#include <doctest/doctest.h>

#include "cordon/registry/registry.hpp"
#include "registry/temporary.hpp"

using namespace cordon;
using namespace test;

namespace {

class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { unsetenv(name_); }

 private:
  const char* name_;
};

/// How often libraries that keep a trace were opened while this object lives.
class Traces {
 public:
  long count() const {
    const std::string text = read(file_);
    return std::count(text.begin(), text.end(), '\n');
  }

 private:
  TemporaryDirectory directory_;
  fs::path file_ = directory_ / "trace";
  Variable variable_{"CORDON_TEST_TRACE", file_.string()};
};

PluginReport::State state_of(const fs::path& file) {
  Registry registry;
  return registry.load_file(file).state;
}

}  // namespace

TEST_CASE("nothing runs of a library whose descriptor is not there or does not fit") {
  const Traces traces;
  for (const char* name :
       {"no_descriptor", "wrong_tag", "wrong_size", "wrong_version", "fast_math"})
    CHECK(state_of(bad(name)) == PluginReport::State::refused);
  CHECK(traces.count() == 0);
}

TEST_CASE("nothing runs of a plugin that is shadowed") {
  const TemporaryDirectory first, second;
  const fs::path winner = first.add(fs::path(CORDON_TRACING_PLUGINS) / "tracing.so");
  second.add(winner, "later.so");
  Registry registry;
  registry.load({{first.path()}});
  const Traces traces;
  registry.load({{second.path()}});
  CHECK(registry.reports().back().state == PluginReport::State::shadowed);
  CHECK(traces.count() == 0);
}

TEST_CASE(
    "a new file is tried in a child process once in a process, and again when it has changed") {
  const TemporaryDirectory directory, cache;
  const Variable place("XDG_CACHE_HOME", cache.path().string());
  const fs::path file = directory.add(fs::path(CORDON_TRACING_PLUGINS) / "tracing.so");
  const auto openings = [&] {
    const Traces traces;
    CHECK(state_of(file) == PluginReport::State::loaded);
    return traces.count();
  };
  CHECK(openings() == 2);
  CHECK(openings() == 1);
  std::ofstream(file, std::ios::binary | std::ios::app) << "behind its end";
  CHECK(openings() == 2);
  CHECK(openings() == 1);
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(1));
  CHECK(openings() == 2);
  CHECK_FALSE(fs::exists(cache / "cordon"));  // another process has to see for itself
}

TEST_CASE("a library that never ends is a refusal, which is remembered") {
  const fs::path file = fs::path(CORDON_SLOW_PLUGINS) / "never_ends.so";
  Registry registry;
  const PluginReport report = registry.load_file(file);
  CHECK(report.state == PluginReport::State::refused);
  CHECK_MESSAGE(report.reason.starts_with("it does not come back from being opened"),
                report.reason);  // by either limit
  CHECK(registry.load_file(file).reason == report.reason);
  CHECK(registry.load_file(good("test_box")).state == PluginReport::State::loaded);
}

TEST_CASE("the host's arithmetic stays as it is, whatever a library does to it") {
  const TemporaryDirectory directory;
  const fs::path file = directory.add(fs::path(CORDON_TRACING_PLUGINS) / "tracing.so");
  CHECK(state_of(file) == PluginReport::State::loaded);
  {
    const Variable other("CORDON_TEST_ROUND_UP", "1");  // unlike in its trial
    CHECK(state_of(file) == PluginReport::State::loaded);
    CHECK(std::fegetround() == FE_TONEAREST);
  }
  CHECK(state_of(bad("flushes_subnormals")) == PluginReport::State::refused);
  volatile double smallest = std::numeric_limits<double>::min();
  CHECK(smallest / 2 > 0);
}

TEST_CASE("while another thread works, plugins are loaded all the same") {
  std::atomic<bool> stop = false;
  std::thread busy([&] {
    while (!stop) std::free(std::malloc(100));
  });
  const TemporaryDirectory directory;
  for (int i = 0; i < 20; ++i) {
    const std::string name = std::to_string(i) + ".so";
    CHECK(state_of(directory.add(good("test_box"), name)) == PluginReport::State::loaded);
  }
  stop = true;
  busy.join();
}
