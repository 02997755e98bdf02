// SPDX-License-Identifier: GPL-3.0-or-later
// One step of `prediction_correction` on ellipsoids, three states and two outputs, along a
// simulated run: predict, correct, reduce.
#include <cmath>

#include <benchmark/benchmark.h>

#include "allocations.hpp"
#include "registry.hpp"
#include "three_states.hpp"

namespace {

using namespace cordon;

void ellipsoid_step(benchmark::State& state, const Params& params) {
  const Model model = three_states();
  const LinearModel& m = model.linear;
  const auto observer = registry().make<ObserverEntry>(
      "prediction_correction", {model, registry().make<BackendEntry>("ellipsoid", params)}, {});
  observer->start();
  Vector x{{.5, -.5, 0}};
  Index k = 0;
  long allocated = 0;
  for (auto _ : state) {
    const auto t = static_cast<double>(k);
    const Vector u{{std::sin(.2 * t)}}, w{{.5 * std::sin(t), .5 * std::cos(3 * t)}},
        v{{.5 * std::cos(2 * t), .5 * std::sin(5 * t)}};
    const Sample now{k, u, m.C * x + m.Dv * v};
    const long before = bench::allocations();
    benchmark::DoNotOptimize(observer->step(now));
    allocated += bench::allocations() - before;
    state.SetIterationTime(observer->times().step() * 1e-6);
    x = m.A * x + m.B * u + m.Bw * w;
    ++k;
  }
  state.counters["allocations"] =
      static_cast<double>(allocated) / static_cast<double>(state.iterations());
}

const int ellipsoid_steps = [] {
  for (const char* criterion : {"trace", "volume"}) {
    for (const char* rounding : {"nominal", "outward"}) {
      const Params params =
          Params().set("criterion", std::string(criterion)).set("rounding", std::string(rounding));
      benchmark::RegisterBenchmark((std::string("ellipsoid/") + criterion + "/" + rounding).c_str(),
                                   [=](benchmark::State& state) { ellipsoid_step(state, params); })
          ->UseManualTime()
          ->Unit(benchmark::kMicrosecond)
          ->MinTime(.05)
          ->Repetitions(7);
    }
  }
  return 0;
}();

}  // namespace
