// SPDX-License-Identifier: GPL-3.0-or-later
// One step of a consistency bank of the four descriptor models of [Rego2025, sec. 6.2], through plugins as in a run: while all of
// them are candidates, and while one is monitored and the others cost nothing.
#include <array>
#include <memory>

#include <benchmark/benchmark.h>

#include "cordon/registry/registry.hpp"

namespace {

using namespace cordon;

const Registry& registry() {
  static const std::unique_ptr<const Registry> instance = [] {
    auto made = std::make_unique<Registry>();
    made->load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
    return made;
  }();
  return *instance;
}

LineForm cube(Index n, double radius) { return make_zonotope(Vector::Zero(n), radius * Matrix::Identity(n, n)); }

ModeBank four_models() {
  LinearModel m;
  m.E = Vector{{1, 1, 0}}.asDiagonal();
  m.A = Matrix{{.5, 0, 0}, {.8, .95, 0}, {-1, .5, 1}};
  m.B = Matrix{{1, 0}, {0, 1}, {0, 0}};
  m.Bw = Vector{{.1, 1.5, .6}}.asDiagonal();
  m.C = Matrix{{1, -1, 0}};
  m.D = Matrix::Zero(1, 2);
  m.Dv = Matrix{{.5}};
  std::array<LinearModel, 4> models{m, m, m, m};
  models[1].A(0, 2) = .5;
  models[2].B = Matrix{{1, 0}, {0, .9}, {-.1, 0}};
  models[3].C(0, 2) = .1;
  const LineForm X0 = make_zonotope(Vector{{.5, .5, .25}}, Vector{{.1, 1.5, .6}}.asDiagonal().toDenseMatrix());
  ModeBank bank;
  for (const LinearModel& linear : models) {
    bank.modes.push_back({"model_" + std::to_string(bank.modes.size() + 1), {linear, X0, cube(3, .1), cube(1, .1)}});
  }
  return bank;
}

/// Four samples of model 1 without disturbances, over and over: under the separating input model 1 is the only one left with the
/// last of them, under the constant reference input none is excluded.
void steps(benchmark::State& state, const std::string& backend_name, bool separating, std::int64_t threads) {
  Params observer, parameters;
  observer.set("max_generators", std::int64_t{30}).set("max_constraints", std::int64_t{8}).set("static_at_start", true);
  if (backend_name == "constrained_zonotope") observer.set("admissible_set", cube(3, 50));
  parameters.set("observer", std::make_shared<const ComponentSpec>(ComponentSpec{"descriptor", observer}));
  parameters.set("waiting_time", std::int64_t{4}).set("threads", threads);
  const ModeBank bank = four_models();
  const auto backend = registry().make_backend(backend_name, {});
  const auto diagnoser = registry().make_diagnoser("consistency_bank", bank, backend, parameters);
  const std::array<Vector, 4> inputs =
      separating ? std::array<Vector, 4>{Vector{{.5, -1}}, Vector{{-3.4399, -1}}, Vector{{1.0854, -7.0632}}, Vector{{.5, -1}}}
                 : std::array<Vector, 4>{Vector{{.5, -1}}, Vector{{.5, -1}}, Vector{{.5, -1}}, Vector{{.5, -1}}};
  const LinearModel& m = bank[0].model.linear;
  std::array<Sample, 4> samples;
  Vector x{{.5, .5, .25}};
  for (std::size_t k = 0; k < 4; ++k) {
    samples[k] = {static_cast<Index>(k), inputs[k], m.C * x};
    x = m.A * x + m.B * inputs[k];
    x[2] = x[0] - .5 * x[1];  // static row
  }
  std::size_t k = 0;
  double left = 0, runs = 0;
  for (auto _ : state) {
    if (k == 0) diagnoser->start();
    const Diagnosis diagnosis = diagnoser->step(samples[k]);
    state.SetIterationTime(diagnoser->step_us() * 1e-6);
    k = (k + 1) % 4;
    if (k != 0) continue;
    ++runs;
    for (const ModeEvidence& evidence : diagnosis.modes) left += evidence.candidate ? 1 : 0;
  }
  state.counters["left"] = runs > 0 ? left / runs : 0;
}

const int registered = [] {
  for (const char* backend : {"line_zonotope", "constrained_zonotope"}) {
    const auto add = [backend](const std::string& name, bool separating, std::int64_t threads) {
      benchmark::RegisterBenchmark(("consistency_bank/4_descriptor_models/" + name + "/" + backend).c_str(),
                                   [=](benchmark::State& state) { steps(state, backend, separating, threads); })
          ->UseManualTime()
          ->Repetitions(7)
          ->Unit(benchmark::kMicrosecond)
          ->MinTime(.05);
    };
    add("separating", true, 1);
    add("reference", false, 1);
    add("reference_2_threads", false, 2);
  }
  return 0;
}();

}  // namespace
