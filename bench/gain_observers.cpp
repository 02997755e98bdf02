// SPDX-License-Identifier: GPL-3.0-or-later
// One step of the observers that correct by a gain, three states and two outputs, whole: with the
// checks of the sample and the question whether the estimate is empty.
#include <string>

#include <benchmark/benchmark.h>

#include "registry.hpp"

namespace {

using namespace cordon;

Model gain_plant() {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.9, .2, 0}, {-.2, .9, .1}, {0, -.1, .95}};
  m.B = Matrix{{0}, {.1}, {.2}};
  m.Bw = Matrix{{.02, 0}, {.03, .01}, {0, .05}};
  m.C = Matrix{{1, 0, 0}, {0, .5, 1}};
  m.D = Matrix::Zero(2, 1);
  m.Dv = Matrix{{.1, .05}, {0, .08}};
  const auto cube = [](Index n) { return make_zonotope(Vector::Zero(n), Matrix::Identity(n, n)); };
  model.X0 = cube(3);
  model.W = model.V = cube(2);
  model.U = make_space(1);
  return model;
}

void gain_step(benchmark::State& state, const std::string& name, const std::string& backend,
               const Params& params) {
  Params sets;
  if (backend != "interval") sets.set("reduction", std::string("girard"));
  const auto observer = registry().make<ObserverEntry>(
      name, {gain_plant(), registry().make<BackendEntry>(backend, sets)}, params);
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
