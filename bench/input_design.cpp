// SPDX-License-Identifier: GPL-3.0-or-later
// Design of a separating input for the four descriptor models of [Rego2025, sec. 6.2] by the search over facets: tubes, pairs,
// facets, search, and the certificates of what was found.
#include <string>

#include <benchmark/benchmark.h>

#include "registry.hpp"

namespace {

using namespace cordon;

LineForm cube(Index n, double radius) { return make_box({Vector::Constant(n, -radius), Vector::Constant(n, radius)}); }

ModeBank four_models() {
  Model model;
  LinearModel& m = model.linear;
  const Vector noise = (Vector(3) << .1, 1.5, .6).finished();
  m.E = Matrix::Identity(3, 3);
  m.E(2, 2) = 0;
  m.A = (Matrix(3, 3) << .5, 0, 0, .8, .95, 0, -1, .5, 1).finished();
  m.B = Matrix::Identity(3, 2);
  m.Bw = noise.asDiagonal();
  m.C = (Matrix(1, 3) << 1, -1, 0).finished();
  m.D = Matrix::Zero(1, 2);
  m.Dv = Matrix::Constant(1, 1, .5);
  model.X0 = make_zonotope((Vector(3) << .5, .5, .25).finished(), m.Bw);
  model.W = cube(3, .1);
  model.V = cube(1, .1);
  model.U = cube(2, 8);
  ModeBank bank;
  for (const char* name : {"1", "2", "3", "4"}) bank.modes.push_back({name, model});
  bank.modes[1].model.linear.A(0, 2) = .5;
  bank.modes[2].model.linear.B(1, 1) = .9;
  bank.modes[2].model.linear.B(2, 0) = -.1;
  bank.modes[3].model.linear.C(0, 2) = .1;
  return bank;
}

void design(benchmark::State& state, std::int64_t horizon, const std::string& cost) {
  const Matrix reference = (Matrix(1, 2) << .5, -1).finished();
  const Params params = Params()
                            .set("horizon", horizon)
                            .set("cost", cost)
                            .set("reference", reference)
                            .set("first_input", Vector(reference.transpose()))
                            .set("epsilon", 1e-4);
  const auto designer = registry().make_designer("facets", four_models(), registry().make_backend("line_zonotope", {}), params);
  DesignControl control;
  DesignOutcome outcome;
  for (auto _ : state) benchmark::DoNotOptimize(outcome = designer->design(control));
  if (outcome.status != DesignStatus::optimal) state.SkipWithError("not proven optimal");
  state.counters["nodes"] = static_cast<double>(outcome.nodes);
  state.counters["programs"] = static_cast<double>(outcome.programs);
  state.counters["facets"] = static_cast<double>(outcome.facets);
}

const int registered = [] {
  for (const std::int64_t horizon : {3, 4}) {
    for (const std::string cost : {"norm_1", "norm_inf", "quadratic"}) {
      const std::string name = "input_design/facets/" + cost + "/horizon:" + std::to_string(horizon);
      benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) { design(state, horizon, cost); })
          ->Unit(benchmark::kMicrosecond)
          ->Repetitions(7);
    }
  }
  return 0;
}();

}  // namespace
