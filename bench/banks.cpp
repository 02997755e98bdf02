// SPDX-License-Identifier: GPL-3.0-or-later
// One step of a bank of observers on zonotopes, through plugins as in a run: while a mode is
// monitored, and while all are candidates.
#include <cmath>
#include <memory>
#include <random>

#include <benchmark/benchmark.h>

#include "registry.hpp"

namespace {

using namespace cordon;

LineForm box(const Vector& center, double radius) {
  return make_zonotope(center, radius * Matrix::Identity(center.size(), center.size()));
}

/// A stable plant with one output per `per_output` states, and modes that differ in effectiveness
/// and disturbance.
ModeBank random_bank(Index n, Index modes, Index per_output) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto draw = [&](Index rows, Index cols) {
    return Matrix(Matrix::NullaryExpr(rows, cols, [&] { return uniform(engine); }));
  };
  Model model;
  LinearModel& m = model.linear;
  const Index outputs = (n + per_output - 1) / per_output;
  m.A = draw(n, n);
  m.A *= .8 / m.A.cwiseAbs().rowwise().sum().maxCoeff();
  m.B = draw(n, 2);
  m.Bw = Matrix::Identity(n, n);
  m.C = draw(outputs, n);
  m.D = Matrix::Zero(outputs, 2);
  m.Dv = Matrix::Identity(outputs, outputs);
  model.X0 = box(Vector::Zero(n), .1);
  model.W = box(Vector::Zero(n), .01);
  model.V = box(Vector::Zero(outputs), .01);
  model.U = box(Vector::Zero(2), 1);
  const LinearModel plant = m;
  ModeBank bank;
  for (Index j = 0; j < modes; ++j) {
    const double high = 1 - .9 * static_cast<double>(j) / static_cast<double>(modes);
    model.linear = plant;
    model.linear.actuator = {Vector{{.9 * high, high}}, Vector{{high, high}}};
    bank.modes.push_back({"mode_" + std::to_string(j), model});
  }
  return bank;
}

/// The data are those of the nominal mode; with `isolating`, of none.
void steps(benchmark::State& state, const ModeBank& bank, std::int64_t threads, bool isolating) {
  Params zonotopes, parameters;
  zonotopes.set("reduction", std::string("combastel"));
  parameters.set("waiting_time", std::int64_t{20})
      .set("max_generators", std::int64_t{20})
      .set("threads", threads);
  const auto backend = registry().make<BackendEntry>("zonotope", zonotopes);
  const auto diagnoser =
      registry().make<DiagnoserEntry>("observer_bank", {bank, backend}, parameters);
  const LinearModel& m = bank[0].model.linear;
  Vector x = Vector::Zero(m.states());
  Index k = 0;
  const auto next = [&] {
    Vector u(2);
    for (Index i = 0; i < 2; ++i) u[i] = std::sin(.3 * static_cast<double>(k * (i + 1)));
    Sample sample{k, u, m.C * x};
    x = m.A * x + m.B * u;
    ++k;
    return sample;
  };
  for (int i = 0; i < 50; ++i) diagnoser->step(next());
  std::int64_t counted = 0;
  for (auto _ : state) {
    Sample sample = next();
    if (isolating)
      sample.y.setConstant(1e3);  // no mode explains it: every copy is excluded and made anew
    diagnoser->step(sample);
    state.SetIterationTime(diagnoser->step_us() * 1e-6);
    ++counted;
  }
  state.counters["steps"] = static_cast<double>(counted);
}

const int registered = [] {
  static const ModeBank small = random_bank(2, 3, 2), large = random_bank(10, 50, 5);
  const auto add = [](const char* name, const ModeBank& bank, std::int64_t threads,
                      bool isolating) {
    benchmark::RegisterBenchmark(name,
                                 [&bank, threads, isolating](benchmark::State& state) {
                                   steps(state, bank, threads, isolating);
                                 })
        ->UseManualTime()
        ->Repetitions(7)
        ->Unit(benchmark::kMicrosecond)
        ->MinTime(.1);
  };
  add("bank/3_modes_2_states/monitoring", small, 1, false);
  add("bank/3_modes_2_states/resetting", small, 1, true);
  add("bank/50_modes_10_states/monitoring", large, 1, false);
  add("bank/50_modes_10_states/resetting", large, 1, true);
  add("bank/50_modes_10_states/monitoring_2_threads", large, 2, false);
  return 0;
}();

}  // namespace
