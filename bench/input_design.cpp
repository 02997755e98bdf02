// SPDX-License-Identifier: GPL-3.0-or-later
// Design of a separating input for the four descriptor models of [Rego2025, sec. 6.2]: tubes,
// pairs, cones, facets, search, and the certificates of what was found.
#include <string>

#include <benchmark/benchmark.h>

#include "input_design/systems.hpp"
#include "registry.hpp"

namespace {

using namespace cordon;

void design(benchmark::State& state, std::int64_t horizon, const std::string& cost) {
  const Matrix reference = (Matrix(1, 2) << .5, -1).finished();
  const Params params = Params()
                            .set("horizon", horizon)
                            .set("cost", cost)
                            .set("reference", reference)
                            .set("first_input", Vector(reference.transpose()))
                            .set("epsilon", 1e-4);
  const auto designer = registry().make<DesignerEntry>(
      "facets",
      {examples::four_descriptor_models(), registry().make<BackendEntry>("line_zonotope", {})},
      params);
  DesignControl control;
  DesignOutcome outcome;
  for (auto _ : state) benchmark::DoNotOptimize(outcome = designer->design(control));
  if (outcome.status != DesignStatus::optimal) state.SkipWithError("not proven optimal");
  state.counters["nodes"] = static_cast<double>(outcome.nodes);
  state.counters["programs"] = static_cast<double>(outcome.programs);
  state.counters["facets"] = static_cast<double>(outcome.facets);
}

const int registered = [] {
  for (const std::int64_t horizon : {3, 4, 5}) {
    for (const std::string cost : {"norm_1", "norm_inf", "quadratic"}) {
      if (horizon == 5 && cost != "norm_1") continue;
      const std::string name =
          "input_design/facets/" + cost + "/horizon:" + std::to_string(horizon);
      benchmark::RegisterBenchmark(name.c_str(),
                                   [=](benchmark::State& state) { design(state, horizon, cost); })
          ->Unit(benchmark::kMicrosecond)
          ->Repetitions(7);
    }
  }
  return 0;
}();

}  // namespace
