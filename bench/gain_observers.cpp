// SPDX-License-Identifier: GPL-3.0-or-later
// One step of the observers that correct by a gain, three states and two outputs, whole: with the
// checks of the sample and the question whether the estimate is empty.
#include <string>

#include <benchmark/benchmark.h>

#include "registry.hpp"
#include "three_states.hpp"

namespace {

using namespace cordon;

void gain_step(benchmark::State& state, const std::string& name, const std::string& backend,
               const Params& params) {
  Params sets;
  if (backend != "interval") sets.set("reduction", std::string("girard"));
  const auto observer = registry().make<ObserverEntry>(
      name, {three_states(), registry().make<BackendEntry>(backend, sets)}, params);
  Sample now{0, Vector::Constant(1, .01), Vector::Constant(2, .02)};
  for (auto _ : state) {
    benchmark::DoNotOptimize(observer->step(now));
    ++now.k;
  }
}

void add_step(const std::string& name, const std::string& backend, const std::string& gain,
              Params params = {}) {
  params.set("gain", std::make_shared<const ComponentSpec>(ComponentSpec{
                         gain == "steady" ? "kalman" : gain,
                         gain == "steady" ? Params().set("steady", true) : Params()}));
  benchmark::RegisterBenchmark(
      (name + "/" + backend + "/" + gain).c_str(),
      [=](benchmark::State& state) { gain_step(state, name, backend, params); })
      ->Unit(benchmark::kMicrosecond)
      ->MinTime(.05)
      ->Repetitions(7);
}

const int gain_steps = [] {
  const Params twenty = Params().set("max_generators", std::int64_t{20});
  for (const char* backend : {"zonotope", "constrained_zonotope"}) {
    add_step("gain_correction", backend, "kalman", twenty);
    add_step("gain_correction", backend, "steady", twenty);
  }
  add_step("luenberger", "zonotope", "steady", twenty);
  add_step("error_hull", "interval", "steady");
  return 0;
}();

}  // namespace
