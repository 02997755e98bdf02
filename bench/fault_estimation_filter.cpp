// SPDX-License-Identifier: GPL-3.0-or-later
// One step of the fault estimation filter on the published descriptor system, through plugins as in a run.
#include <cmath>
#include <memory>

#include <benchmark/benchmark.h>

#include "registry.hpp"

namespace {

using namespace cordon;

/// The example of [Wang2017], without faults.
ModeBank published() {
  Model model;
  LinearModel& m = model.linear;
  m.E = Matrix(Vector{{1, 1, 1, 0}}.asDiagonal());
  m.A = Matrix{{.9, .005, -.095, 0}, {.005, .995, .0997, 0}, {.095, -.0997, .99, 0}, {1, 0, 1, 1}};
  m.B = Matrix{{.1, 0}, {1, 1}, {-.1, 1}, {-1, 0}};
  m.F = m.B;
  m.Bw = Matrix{{.01}, {.01}, {.01}, {0}};
  m.C = Matrix{{0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  m.D = Matrix::Zero(3, 2);
  m.Dv = .01 * Matrix::Identity(3, 3);
  model.X0 = make_zonotope(Vector::Zero(4), .1 * Matrix::Identity(4, 4));
  model.W = make_zonotope(Vector::Zero(1), Matrix::Identity(1, 1));
  model.V = make_zonotope(Vector::Zero(3), Matrix::Identity(3, 3));
  ModeBank bank;
  bank.modes.push_back({"healthy", model});
  return bank;
}

void steps(benchmark::State& state, const char* coupling) {
  Matrix S = Matrix::Zero(4, 7);
  S.leftCols(4).setIdentity();
  S(1, 4) = S(2, 5) = S(3, 6) = 1;
  Params parameters;
  parameters.set("noise_coupling", std::string(coupling)).set("max_columns", std::int64_t{20}).set("free_matrix", S);
  const auto diagnoser =
      registry().make_diagnoser("fault_estimation_filter", published(), registry().make_backend("zonotope", {}), parameters);
  Index k = 0;
  const auto next = [&] {
    Sample sample{k, Vector::Zero(2), Vector(3)};
    for (Index i = 0; i < 3; ++i) sample.y[i] = .01 * std::sin(.3 * static_cast<double>(k * (i + 1)));
    ++k;
    return sample;
  };
  for (int i = 0; i < 50; ++i) diagnoser->step(next());
  std::int64_t counted = 0;
  for (auto _ : state) {
    diagnoser->step(next());
    state.SetIterationTime(diagnoser->step_us() * 1e-6);
    ++counted;
  }
  state.counters["steps"] = static_cast<double>(counted);
}

const int registered = [] {
  for (const char* coupling : {"shared", "independent"}) {
    benchmark::RegisterBenchmark(("fault_estimation_filter/20_columns/" + std::string(coupling)).c_str(),
                                 [coupling](benchmark::State& state) { steps(state, coupling); })
        ->UseManualTime()
        ->Repetitions(7)
        ->Unit(benchmark::kMicrosecond)
        ->MinTime(.1);
  }
  return 0;
}();

}  // namespace
