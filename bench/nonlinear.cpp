// SPDX-License-Identifier: GPL-3.0-or-later
// One step of observers for formulas (prediction, correction, reduction) with sets of 20 generators
// and 8 constraints: two states, and six.
#include <memory>

#include <benchmark/benchmark.h>

#include "allocations.hpp"
#include "cordon/study/data.hpp"
#include "cordon/study/study.hpp"

namespace {

using namespace cordon;

/// Studies are read with the plugins of this build.
Registry& components() {
  static const std::unique_ptr<Registry> all = [] {
    auto made = std::make_unique<Registry>();
    made->load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
    return made;
  }();
  return *all;
}

/// Over and over from the first sample to the last one.
void steps_by_formulas(benchmark::State& state, const Study& study, const PipelineSpec& pipeline) {
  const auto backend =
      components().make<BackendEntry>(pipeline.backend.type, pipeline.backend.params);
  const ComponentSpec& spec = pipeline.estimation()->observer;
  const auto observer =
      components().make<ObserverEntry>(spec.type, {study.model, backend}, spec.params);
  std::vector<Sample> samples;
  const auto source = open_data(study);
  while (const auto record = source->next()) samples.push_back(record->sample);
  std::size_t k = samples.size();
  long allocated = 0;
  for (auto _ : state) {
    if (k == samples.size()) {
      observer->start();
      observer->step(samples[0]);
      k = 1;
    }
    const long before = bench::allocations();
    observer->step(samples[k++]);
    allocated += bench::allocations() - before;
    state.SetIterationTime(observer->times().step() * 1e-6);
  }
  state.counters["allocations"] =
      static_cast<double>(allocated) / static_cast<double>(state.iterations());
}

const int registered_formulas = [] {
  for (const char* states : {"two_states", "six_states"}) {
    static std::vector<std::unique_ptr<Study>> studies;
    const std::string file = std::string(CORDON_SOURCE_DIR "/bench/studies/") + states + ".json";
    studies.push_back(std::make_unique<Study>(read_study(file, components())));
    const Study& study = *studies.back();
    for (const PipelineSpec& pipeline : study.pipelines) {
      benchmark::RegisterBenchmark(
          ("formulas/" + std::string(states) + "/" + pipeline.name).c_str(),
          [&](benchmark::State& state) { steps_by_formulas(state, study, pipeline); })
          ->UseManualTime()
          ->Repetitions(7)
          ->Unit(benchmark::kMicrosecond)
          ->MinTime(.05);
    }
  }
  return 0;
}();

}  // namespace
