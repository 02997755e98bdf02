// SPDX-License-Identifier: GPL-3.0-or-later
// One step of observers of a plant of three states and two outputs by constrained zonotopes of 40
// generators and 10 constraints: of the present state, and of those five samples before.
#include <cmath>

#include <benchmark/benchmark.h>

#include "registry.hpp"
#include "three_states.hpp"

namespace {

using namespace cordon;

/// Of the plant with disturbances and noise of half their bounds.
std::vector<Sample> samples_of(const Model& model, Index steps) {
  const LinearModel& m = model.linear;
  std::vector<Sample> all;
  Vector x{{.5, -.5, 0}};
  for (Index k = 0; k < steps; ++k) {
    const auto t = static_cast<double>(k);
    const Vector u{{std::sin(.2 * t)}}, w{{.5 * std::sin(t), .5 * std::cos(3 * t)}},
        v{{.5 * std::cos(2 * t), .5 * std::sin(5 * t)}};
    all.push_back({k, u, m.C * x + m.Dv * v});
    x = m.A * x + m.B * u + m.Bw * w;
  }
  return all;
}

void step(benchmark::State& state, const std::string& name, Params params) {
  const Model model = three_states();
  const std::vector<Sample> samples = samples_of(model, 100);
  params.set("max_generators", std::int64_t{40}).set("max_constraints", std::int64_t{10});
  const auto observer = registry().make<ObserverEntry>(
      name, {model, registry().make<BackendEntry>("constrained_zonotope", {})}, params);
  std::size_t k = samples.size();
  for (auto _ : state) {
    if (k >= samples.size()) {
      observer->start();
      for (k = 0; k < 20; ++k) observer->step(samples[k]);
    }
    benchmark::DoNotOptimize(observer->step(samples[k++]));
    state.SetIterationTime(observer->times().step() * 1e-6);
  }
}

void add_watched(const std::string& name, const std::string& what, const Params& params = {}) {
  benchmark::RegisterBenchmark((name + "/three_states/40/10" + what).c_str(),
                               [=](benchmark::State& state) { step(state, name, params); })
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond)
      ->MinTime(.05)
      ->Repetitions(7);
}

const int registered = [] {
  add_watched("prediction_correction", "");
  add_watched("fixed_lag", "/5", Params().set("lag", std::int64_t{5}));
  return 0;
}();

}  // namespace
