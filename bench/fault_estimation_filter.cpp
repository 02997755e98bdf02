// SPDX-License-Identifier: GPL-3.0-or-later
// One step of the fault estimation filter on the published descriptor system, through plugins as in
// a run.
#include <cmath>
#include <memory>

#include <benchmark/benchmark.h>

#include "fault_estimation/systems.hpp"
#include "registry.hpp"

namespace {

using namespace cordon;

void steps(benchmark::State& state, const char* coupling) {
  Params parameters;
  parameters.set("noise_coupling", std::string(coupling))
      .set("max_columns", std::int64_t{20})
      .set("free_matrix", faults::published_S());
  const ModeBank bank{{{"healthy", faults::published()}}};
  const auto diagnoser = registry().make<DiagnoserEntry>(
      "fault_estimation_filter", {bank, registry().make<BackendEntry>("zonotope", {})}, parameters);
  Index k = 0;
  const auto next = [&] {
    Sample sample{k, Vector::Zero(2), Vector(3)};
    for (Index i = 0; i < 3; ++i)
      sample.y[i] = .01 * std::sin(.3 * static_cast<double>(k * (i + 1)));
    ++k;
    return sample;
  };
  for (int i = 0; i < 50; ++i) diagnoser->step(next());
  std::int64_t counted = 0;
  for (auto _ : state) {
    diagnoser->step(next());
    state.SetIterationTime(diagnoser->step_us() * 1e-6);
    ++counted;
  }
  state.counters["steps"] = static_cast<double>(counted);
}

const int registered = [] {
  for (const char* coupling : {"shared", "independent"}) {
    benchmark::RegisterBenchmark(
        ("fault_estimation_filter/20_columns/" + std::string(coupling)).c_str(),
        [coupling](benchmark::State& state) { steps(state, coupling); })
        ->UseManualTime()
        ->Repetitions(7)
        ->Unit(benchmark::kMicrosecond)
        ->MinTime(.1);
  }
  return 0;
}();

}  // namespace
