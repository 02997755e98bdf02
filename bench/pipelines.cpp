// SPDX-License-Identifier: GPL-3.0-or-later
// One step (predict, correct, reduce; and the certified hull apart) of every pipeline of the main
// study, with nominal and with outward rounding, through plugins as in a run; with the allocations
// of the step. And what comes before the first step.
#include <memory>

#include <benchmark/benchmark.h>

#include "allocations.hpp"
#include "cordon/study/data.hpp"
#include "cordon/study/study.hpp"

namespace {

using namespace cordon;

struct Fixture {
  Registry registry;
  Study nominal, outward;
  Fixture() {
    registry.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
    nominal = read_study(CORDON_SOURCE_DIR "/examples/studies/descriptor_four_representations.json",
                         registry);
    outward = read_study(CORDON_SOURCE_DIR "/examples/studies/descriptor_outward_rounding.json",
                         registry);
  }
};

const Fixture& fixture() {
  static const Fixture instance;
  return instance;
}

/// Runs a pipeline over and over its data up to k = 20 (all pipelines are consistent there); each
/// iteration is one step from k = 2 on.
template <class Work>
void steps(benchmark::State& state, const Study& study, const PipelineSpec& pipeline, Work work) {
  const Registry& registry = fixture().registry;
  const auto backend = registry.make<BackendEntry>(pipeline.backend.type, pipeline.backend.params);
  const ComponentSpec& spec = pipeline.estimation()->observer;
  const auto observer =
      registry.make<ObserverEntry>(spec.type, {study.model, backend}, spec.params);
  std::vector<Sample> samples;
  for (const auto source = open_data(study); samples.size() <= 20;)
    samples.push_back(source->next()->sample);
  std::size_t k = samples.size();
  long allocated = 0;
  for (auto _ : state) {
    if (k >= samples.size()) {
      observer->start();
      observer->step(samples[0]);
      observer->step(samples[1]);
      k = 2;
    }
    const long before = bench::allocations();
    const Estimate estimate = observer->step(samples[k++]);
    allocated += bench::allocations() - before;
    state.SetIterationTime(work(*observer, estimate) * 1e-6);
  }
  state.counters["allocations"] =
      static_cast<double>(allocated) / static_cast<double>(state.iterations());
}

double hull_time(const Estimate& estimate) {
  const auto begin = std::chrono::steady_clock::now();
  benchmark::DoNotOptimize(estimate.set->interval_hull());
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin)
      .count();
}

void add(const std::string& rounding, const Study& study) {
  for (const PipelineSpec& pipeline : study.pipelines) {
    const auto measure = [&](const std::string& what,
                             double (*work)(const Observer&, const Estimate&)) {
      benchmark::RegisterBenchmark((what + rounding + "/" + pipeline.name).c_str(),
                                   [&study, &pipeline, work](benchmark::State& state) {
                                     steps(state, study, pipeline, work);
                                   })
          ->UseManualTime()
          ->Repetitions(7)
          ->Unit(benchmark::kMicrosecond)
          ->MinTime(.05);
    };
    measure("step",
            [](const Observer& observer, const Estimate&) { return observer.times().step(); });
    measure("step_with_question", [](const Observer& observer, const Estimate&) {
      return observer.times().step() + observer.times().question;
    });
    measure("step_with_hull", [](const Observer& observer, const Estimate& e) {
      return observer.times().step() + hull_time(e);
    });
  }
}

void plugins_loaded_and_study_validated(benchmark::State& state) {
  for (auto _ : state) {
    Registry registry;
    registry.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
    benchmark::DoNotOptimize(read_study(
        CORDON_SOURCE_DIR "/examples/studies/descriptor_four_representations.json", registry));
  }
}
BENCHMARK(plugins_loaded_and_study_validated)
    ->Repetitions(7)
    ->Unit(benchmark::kMicrosecond)
    ->MinTime(.05);

const int registered = [] {
  add("", fixture().nominal);
  add("_outward", fixture().outward);
  return 0;
}();

}  // namespace
