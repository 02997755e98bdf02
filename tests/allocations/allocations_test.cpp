// SPDX-License-Identifier: GPL-3.0-or-later
// How often a step asks the C library for memory, once there were some steps.
#include "allocations.hpp"

#include <doctest/doctest.h>

#include "cordon/cordon.hpp"
#include "cordon/study/data.hpp"
#include "cordon/study/session.hpp"

using namespace cordon;

namespace {

Study example(Registry& registry, const std::string& name) {
  return read_study(CORDON_SOURCE_DIR "/examples/studies/" + name + ".json", registry);
}

struct Asked {
  long most = 0, steps = 0;
  double mean = 0;
};

/// Of the steps of the last of several runs over the data, hull and result included; the first
/// steps are left out, in which sets still grow.
Asked asked_by(const Study& study, const Registry& registry, std::size_t pipeline) {
  constexpr std::size_t most_samples = 100, first = 6;
  constexpr int runs = 4;
  std::vector<Sample> samples;
  for (const auto source = open_data(study); const auto record = source->next();) {
    if (samples.size() == most_samples) break;
    samples.push_back(record->sample);
  }
  Session session(study, registry, pipeline);
  SessionStep told;
  Asked found;
  for (int run = 1; run <= runs; ++run) {
    session.start();
    for (std::size_t at = 0; at < samples.size(); ++at) {
      const long before = bench::allocations();
      session.step(samples[at], told);
      if (run < runs || at < first) continue;
      found.most = std::max(found.most, bench::allocations() - before);
      found.mean += static_cast<double>(bench::allocations() - before);
      ++found.steps;
    }
  }
  found.mean /= static_cast<double>(found.steps);
  return found;
}

/// Of every pipeline with an observer on one of these backends.
int check_each(const std::string& name, const std::vector<std::string>& backends, long most) {
  Registry registry;
  const Study study = example(registry, name);
  int checked = 0;
  for (std::size_t i = 0; i < study.pipelines.size(); ++i) {
    const PipelineSpec& spec = study.pipelines[i];
    const bool is_one =
        std::find(backends.begin(), backends.end(), spec.backend.type) != backends.end();
    if (!spec.estimation() || !is_one) continue;
    const Asked found = asked_by(study, registry, i);
    CAPTURE(name);
    CAPTURE(spec.name);
    CAPTURE(found.mean);
    CHECK(found.most <= most);
    ++checked;
  }
  return checked;
}

}  // namespace

TEST_CASE("steps with intervals, zonotopes and gains ask for no memory") {
  int checked = 0;
  for (const char* name :
       {"observer_catalogue", "interval_observers_monotone", "interval_observers_non_monotone",
        "linear_two_states", "descriptor_four_representations"})
    checked += check_each(name, {"interval", "zonotope"}, 0);
  CHECK(checked > 25);
}

TEST_CASE("steps with constraints ask for some, hulls included") {
  CHECK(check_each("observer_catalogue", {"constrained_zonotope"}, 40) == 4);
  CHECK(check_each("descriptor_four_representations", {"line_zonotope"}, 60) == 1);
}
