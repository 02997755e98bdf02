// SPDX-License-Identifier: GPL-3.0-or-later
// Memory of a run does not grow with its length.
#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include "run/components.hpp"
#include "run/scratch.hpp"

using namespace cordon;

namespace {

/// Resident memory in MB.
double resident() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024;
  }
  return 0;
}

}  // namespace

TEST_CASE("memory stays flat over 100,000 steps") {
  const Scratch scratch;
  Registry registry;
  registry.add(fakes::register_all);
  RunOptions options;
  options.out = scratch.path();
  double early = 0, late = 0;
  options.progress = [&](std::size_t, std::int64_t done, std::int64_t) {
    if (early == 0 && done > 500) early = resident();
    late = resident();
  };
  const RunOutcome outcome = run_study(fakes::study({fakes::pipeline("p")}, 100000), registry, options);
  REQUIRE(outcome.pipelines[0].steps == 100001);
  REQUIRE(early > 0);
  MESSAGE("resident memory grew by " << late - early << " MB");
  CHECK(late - early < 20);
}
