// SPDX-License-Identifier: GPL-3.0-or-later
// One step of the observers of uncertain systems on the three-state plant of [Pourasghar2021,
// (68)], whole: with the checks of the sample, the set that is handed out and the question whether
// it is empty.
#include <benchmark/benchmark.h>

#include "registry.hpp"

namespace {

using namespace cordon;

Model plant() {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.8, .1, .3}, {0, .8, .2}, {.01, 0, .8}};
  m.A_radius = Matrix::Constant(3, 3, .01);
  m.B = Matrix{{0}, {0}, {1}};
  m.Bw = .08 * Matrix::Identity(3, 3);
  m.C = Matrix{{0, 0, 1}};
  m.D = Matrix::Zero(1, 1);
  m.Dv = Matrix{{.2}};
  model.X0 = make_zonotope(Vector::Zero(3), .1 * Matrix::Identity(3, 3));
  model.W = make_zonotope(Vector::Zero(3), Matrix::Identity(3, 3));
  model.V = make_zonotope(Vector::Zero(1), Matrix::Identity(1, 1));
  model.U = make_space(1);
  return model;
}

void step(benchmark::State& state, const std::string& name, const std::string& backend,
          Params params) {
  const auto gain = std::make_shared<const ComponentSpec>(
      ComponentSpec{"given", Params().set("matrix", Matrix{{.3}, {.2}, {.8}})});
  Params sets;
  if (backend == "zonotope") sets.set("reduction", std::string("combastel"));
  const auto observer = registry().make<ObserverEntry>(
      name, {plant(), registry().make<BackendEntry>(backend, sets)}, params.set("gain", gain));
  Sample now{0, Vector::Constant(1, .5), Vector::Constant(1, .7)};
  for (auto _ : state) {
    benchmark::DoNotOptimize(observer->step(now));
    ++now.k;
  }
}

void add(const std::string& name, const std::string& backend, const std::string& what = "",
         Params params = {}) {
  benchmark::RegisterBenchmark((name + "/" + backend + what).c_str(),
                               [=](benchmark::State& state) { step(state, name, backend, params); })
      ->Unit(benchmark::kMicrosecond)
      ->MinTime(.05)
      ->Repetitions(7);
}

const int registered = [] {
  add("interval_trajectory", "interval");
  add("integrated", "interval");
  add("interval_trajectory", "zonotope");
  add("zonotope_uncertain", "zonotope", "/20", Params().set("max_generators", std::int64_t{20}));
  add("zonotope_uncertain", "interval");
  add("interval_trajectory", "interval", "/inner_100",
      Params().set("inner_samples", std::int64_t{100}));
  return 0;
}();

}  // namespace
