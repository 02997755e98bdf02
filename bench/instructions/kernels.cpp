// SPDX-License-Identifier: GPL-3.0-or-later
// Work whose instructions scripts/count-instructions counts: kernels NAME runs one kernel, inside
// `counted`.
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "cordon/sets/constraint_elimination.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "cordon/study/data.hpp"
#include "cordon/study/study.hpp"
#include "random_set.hpp"
#include "registry.hpp"
#include "three_states.hpp"

namespace {

using namespace cordon;
using namespace cordon::bench;

volatile double sink = 0;

/// The only thing that is counted.
[[gnu::noinline]] void counted(const std::function<double()>& work) { sink = sink + work(); }

LineForm medium_set() { return random_set({10, 100, 20}); }

void interval_hull_of_set() {
  const LineForm X = medium_set();
  counted([&] { return interval_hull(X).upper[0]; });
}

void emptiness_of_both_kinds() {
  const LineForm full = medium_set();
  LineForm empty = full;
  empty.b *= 16;
  counted(
      [&] { return static_cast<double>(is_empty(full)) + static_cast<double>(is_empty(empty)); });
}

void containment_near_boundary() {
  const LineForm X = medium_set();
  const Box hull = interval_hull(X);
  const Vector x = .5 * hull.center() + .5 * X.c, far = x + .45 * hull.upper - .45 * hull.center();
  counted(
      [&] { return static_cast<double>(contains(X, x)) + static_cast<double>(contains(X, far)); });
}

void constraint_elimination_to_5() {
  const LineForm X = medium_set();
  counted([&] { return sets::eliminate_constraints(X, 5).set.G(0, 0); });
}

/// Steps 2 to 20 of the line zonotopes of the main study, each with its certified hull.
void steps_of_main_study() {
  Registry registry;
  registry.load({{std::filesystem::path(CORDON_BINARY_DIR) / "lib/cordon/plugins-v1"}});
  const Study study = read_study(
      CORDON_SOURCE_DIR "/examples/studies/descriptor_four_representations.json", registry);
  const PipelineSpec& pipeline = study.pipelines.front();
  const auto backend = registry.make<BackendEntry>(pipeline.backend.type, pipeline.backend.params);
  const ComponentSpec& spec = pipeline.estimation()->observer;
  const auto observer =
      registry.make<ObserverEntry>(spec.type, {study.model, backend}, spec.params);
  std::vector<Sample> samples;
  for (const auto source = open_data(study); samples.size() <= 20;)
    samples.push_back(source->next()->sample);
  observer->start();
  observer->step(samples[0]);
  observer->step(samples[1]);
  counted([&] {
    double sum = 0;
    for (std::size_t k = 2; k < samples.size(); ++k)
      sum += observer->step(samples[k]).set->interval_hull().upper[0];
    return sum;
  });
}

/// A hundred steps of an observer with a gain, with the questions that each asks; the sets have
/// settled before.
void steps_with_gain(const std::string& name, const std::string& backend, bool steady) {
  Params sets, params;
  if (backend != "interval") {
    sets.set("reduction", std::string("girard"));
    params.set("max_generators", std::int64_t{20});
  }
  params.set("gain", std::make_shared<const ComponentSpec>(
                         ComponentSpec{"kalman", Params().set("steady", steady)}));
  const auto observer = registry().make<ObserverEntry>(
      name, {three_states(), registry().make<BackendEntry>(backend, sets)}, params);
  Sample now{0, Vector::Constant(1, .01), Vector::Constant(2, .02)};
  for (; now.k < 200; ++now.k) observer->step(now);
  counted([&] {
    double found = 0;
    for (; now.k < 300; ++now.k)
      found += static_cast<double>(observer->step(now).consistent == Answer::yes);
    return found;
  });
}

const std::map<std::string, void (*)()> kernels{
    {"interval_hull", interval_hull_of_set},
    {"emptiness", emptiness_of_both_kinds},
    {"containment", containment_near_boundary},
    {"constraint_elimination", constraint_elimination_to_5},
    {"line_zonotope_steps", steps_of_main_study},
    {"luenberger", [] { steps_with_gain("luenberger", "zonotope", true); }},
    {"error_hull", [] { steps_with_gain("error_hull", "interval", true); }},
    {"gain_correction", [] { steps_with_gain("gain_correction", "zonotope", true); }},
    {"gain_correction_kalman", [] { steps_with_gain("gain_correction", "zonotope", false); }},
    {"gain_correction_constrained",
     [] { steps_with_gain("gain_correction", "constrained_zonotope", true); }}};

}  // namespace

int main(int argc, char** argv) {
  const auto kernel = kernels.find(argc == 2 ? argv[1] : "");
  if (kernel == kernels.end()) {
    for (const auto& [name, work] : kernels) std::printf("%s\n", name.c_str());
    return argc == 1 ? 0 : 2;
  }
  kernel->second();
  return 0;
}
