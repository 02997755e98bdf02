// SPDX-License-Identifier: GPL-3.0-or-later
// One step of a consistency bank of the four descriptor models of [Rego2025, sec. 6.2], through
// plugins as in a run: while all of them are candidates, and while one is monitored and the others
// cost nothing.
#include <algorithm>
#include <array>

#include <benchmark/benchmark.h>

#include "cordon/study/study.hpp"
#include "registry.hpp"

namespace {

using namespace cordon;

/// The study of the example: its bank, and its observers for each backend.
const Study& study() {
  static const Study instance = [] {
    Registry plugins;
    plugins.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
    return read_study(CORDON_SOURCE_DIR "/examples/studies/consistency_four_models.json", plugins,
                      {});
  }();
  return instance;
}

/// Four samples of model 1 without disturbances, over and over: under the separating input model 1
/// is the only one left with the last of them, under the constant reference input none is excluded.
void steps(benchmark::State& state, const std::string& backend_name, bool separating,
           std::int64_t threads) {
  const auto pipeline =
      std::find_if(study().pipelines.begin(), study().pipelines.end(),
                   [&](const PipelineSpec& p) { return p.backend.type == backend_name; });
  Params parameters = pipeline->diagnosis()->diagnoser.params;
  parameters.set("threads", threads);
  const ModeBank bank = bank_of(study());
  const auto backend = registry().make<BackendEntry>(backend_name, {});
  const auto diagnoser =
      registry().make<DiagnoserEntry>("consistency_bank", {bank, backend}, parameters);
  const std::array<Vector, 4> inputs =
      separating ? std::array<Vector, 4>{Vector{{.5, -1}}, Vector{{-3.4399, -1}},
                                         Vector{{1.0854, -7.0632}}, Vector{{.5, -1}}}
                 : std::array<Vector, 4>{Vector{{.5, -1}}, Vector{{.5, -1}}, Vector{{.5, -1}},
                                         Vector{{.5, -1}}};
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
      benchmark::RegisterBenchmark(
          ("consistency_bank/4_descriptor_models/" + name + "/" + backend).c_str(),
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
