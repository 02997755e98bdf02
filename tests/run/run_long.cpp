// SPDX-License-Identifier: GPL-3.0-or-later
// Memory of a run does not grow with its length.
#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include "run/components.hpp"
#include "run/scratch.hpp"
#include "study/running/run_on.hpp"

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

/// MB by which the memory of a run grows after its first steps.
double growth_of(const Study& study, const detail::OpenData& open) {
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
  const RunOutcome outcome = detail::run_on(open, study, registry, options);
  REQUIRE(outcome.pipelines[0].steps == 100001);
  REQUIRE(early > 0);
  MESSAGE("resident memory grew by " << late - early << " MB");
  return late - early;
}

}  // namespace

TEST_CASE("memory stays flat over 100,000 steps") {
  const Study study = fakes::study({fakes::pipeline("p", "offering")}, 100000);
  CHECK(growth_of(study, [&](std::uint64_t offset) { return open_data(study, offset); }) < 20);
}

TEST_CASE("memory of a diagnosis with bounds of additive faults stays flat over 100,000 steps") {
  const Study study = fakes::study_with_faults({}, 100000);
  CHECK(growth_of(study, [&](std::uint64_t offset) {
          return std::make_unique<fakes::WithFaults>(open_data(study, offset));
        }) < 20);
}
