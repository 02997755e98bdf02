// SPDX-License-Identifier: GPL-3.0-or-later
// Every diagnoser goes on from a saved state with the same bits: through faults, resets and gaps.
#include <cmath>
#include <limits>
#include <set>

#include "diagnosis/banks.hpp"
#include "diagnosis/with_observer.hpp"
#include "fault_estimation/systems.hpp"
#include "nonlinear/reference.hpp"
#include "nonlinear/trajectory.hpp"
#include "saved_state/going_on.hpp"

using namespace cordon;
using namespace saved_state;

namespace {

const std::vector<std::size_t> moments{0, 1, 2, 12, 21, 26, 31, 38, 52, 60};

Sample with_gap(Sample sample, const std::vector<Index>& missing) {
  sample.missing = missing;
  for (const Index i : missing) sample.y[i] = std::numeric_limits<double>::quiet_NaN();
  return sample;
}

/// Two outputs, one of which is lost from 20 to 23; another mode from 30 on, and back at 48.
ModeBank switched_bank() {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.7, .2}, {-.2, .6}};
  m.B = Matrix{{1, .2}, {.3, 1}};
  m.Bw = m.Dv = Matrix::Identity(2, 2);
  m.C = Matrix{{1, .5}, {0, 1}};
  m.D = Matrix::Zero(2, 2);
  const auto cube = [](double half) {
    return make_box({Vector::Constant(2, -half), Vector::Constant(2, half)});
  };
  model.X0 = cube(1);
  model.W = model.V = cube(.02);
  model.U = cube(5);
  ModeBank bank;
  bank.modes.assign(3, {"healthy", model});
  bank.modes[1].name = "weak_actuator";
  bank.modes[1].model.linear.actuator = {Vector{{.2, 1}}, Vector{{.5, 1}}};
  bank.modes[2].name = "dead_actuator";
  bank.modes[2].model.linear.actuator = {Vector{{1, 0}}, Vector{{1, .1}}};
  return bank;
}

std::vector<Sample> switched_samples(const ModeBank& bank, bool has_gaps) {
  banks::Draw draw{std::mt19937_64(4)};
  Vector x = draw.from(bank[0].model.X0);
  std::vector<Sample> all;
  for (Index k = 0; k < 60; ++k) {
    const double angle = .7 * static_cast<double>(k);
    const Vector u{{2 * std::sin(angle) + 1, 2 * std::cos(1.3 * angle) - 1}};
    const Vector y = banks::simulate(bank[k < 30 ? 0 : k < 48 ? 2 : 1].model, x, u, draw);
    Sample sample{k, u, y};
    if (has_gaps && k >= 20 && k < 24) sample = with_gap(sample, {k % 2});
    if (has_gaps && k == 37) sample = with_gap(sample, {0, 1});
    all.push_back(sample);
  }
  return all;
}

struct Named {
  std::string diagnoser, backend;
  Params params;
  ModeBank bank;
  std::vector<Sample> samples;
};

Trial<Diagnoser> trial_of(const Named& choice) {
  Trial<Diagnoser> trial;
  trial.backend = banks::registry().make<BackendEntry>(choice.backend, {});
  trial.samples = choice.samples;
  trial.make = [choice, backend = trial.backend] {
    return banks::registry().make<DiagnoserEntry>(choice.diagnoser, {choice.bank, backend},
                                                  choice.params);
  };
  return trial;
}

Params formulas_with(Params params, const char* changes) {
  return params.set("changes", std::string(changes));
}

/// A tank that may leak.
ModeBank leaking() {
  const auto mode = [](const char* flow) {
    test::Json system = {
        {"states", {"x"}}, {"inputs", {"u"}}, {"disturbances", {"w"}}, {"noises", {"v"}}};
    system["f"] = {std::string("x + u - ") + flow + "*sqrt(x) + w"};
    system["g"] = {"x + v"};
    system["X0"] = {{"center", {4}}, {"generators", {{0.3}}}};
    system["W"] = {{"center", {0}}, {"generators", {{0.01}}}};
    system["V"] = {{"center", {0}}, {"generators", {{0.05}}}};
    return test::model_of(system);
  };
  return {{{"healthy", mode("0.3")}, {"leak", mode("0.33")}}, 0};
}

std::vector<Sample> leaking_samples(const ModeBank& bank, Index leak_at) {
  test::Trajectory plant(bank[0].model, 8), leak(bank[1].model, 8);
  std::vector<Sample> all;
  for (Index k = 0; k < 30; ++k) {
    const Vector u{{k % 8 < 4 ? .65 : .55}};
    test::Trajectory& now = k < leak_at ? plant : leak;
    all.push_back({k, u, now.output(u, k)});
    now.advance(u, k);
  }
  return all;
}

std::vector<Named> all_diagnosers() {
  using diagnosis_test::with_observer;
  std::vector<Named> all;
  const ModeBank bank = switched_bank(), tank = leaking();
  const auto complete = switched_samples(bank, false), gaps = switched_samples(bank, true);
  const LineForm restart = make_box({Vector::Constant(2, -20), Vector::Constant(2, 20)});
  for (const char* backend : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    Params few = Params().set("max_generators", std::int64_t{14});
    for (const auto& samples : {complete, gaps}) {
      all.push_back({"observer_bank", backend,
                     Params(few).set("waiting_time", std::int64_t{6}).set("widening_limit", 1.2),
                     bank, samples});
      for (const char* observer : {"prediction_correction", "gain_correction", "luenberger"}) {
        Params params = with_observer(observer, few, 6);
        params.set("restart_set", restart);
        all.push_back({"consistency_bank", backend, params, bank, samples});
      }
      Params followed = with_observer("prediction_correction", few, 6);
      all.push_back(
          {"consistency_bank", backend, formulas_with(followed, "followed"), bank, samples});
    }
    all.push_back({"consistency_bank", backend, with_observer("nonlinear", few, 6), tank,
                   leaking_samples(tank, 0)});
    all.push_back({"consistency_bank", backend,
                   formulas_with(with_observer("nonlinear", few, 6), "followed"), tank,
                   leaking_samples(tank, 9)});
  }
  ModeBank exact = bank;
  for (Mode& mode : exact.modes) {
    LinearModel& m = mode.model.linear;
    if (m.actuator.dim() > 0) m.B *= m.actuator.lower.asDiagonal();
    m.actuator = {};
  }
  const Params horizon = Params().set("horizon", std::int64_t{14});
  auto faulty = switched_samples(exact, true);
  faulty.resize(24);
  for (const char* backend : {"constrained_zonotope", "line_zonotope"}) {
    all.push_back({"tube_membership", backend, horizon, exact, faulty});
    all.push_back({"tube_membership", backend, horizon, tank, leaking_samples(tank, 0)});
  }
  const Model system = faults::published();
  faults::FaultyRun run(
      system, [](Index k) { return Vector::Constant(2, std::sin(.3 * static_cast<double>(k))); },
      [](Index k) {
        return Vector{{k < 30 ? 0. : 1., 0}};
      },
      {std::mt19937_64(2)});
  std::vector<Sample> whole, lost;
  for (Index k = 0; k < 60; ++k) {
    whole.push_back(run.step());
    lost.push_back(k == 24 || k == 25 || k == 37 ? with_gap(whole.back(), {1}) : whole.back());
  }
  for (const char* coupling : {"shared", "independent"}) {
    for (const std::int64_t columns : {0, 20}) {
      Params params = Params().set("noise_coupling", std::string(coupling));
      params.set("max_columns", columns);
      all.push_back(
          {"fault_estimation_filter", "zonotope", params, {{{"healthy", system}}, 0}, whole});
      params.set("admissible_set", make_box({Vector::Constant(4, -50), Vector::Constant(4, 50)}));
      all.push_back(
          {"fault_estimation_filter", "zonotope", params, {{{"healthy", system}}, 0}, lost});
    }
  }
  return all;
}

}  // namespace

TEST_CASE("diagnosers go on from a saved state with the same bits") {
  std::set<std::string> seen;
  for (const Named& choice : all_diagnosers()) {
    CAPTURE(choice.diagnoser);
    CAPTURE(choice.backend);
    CAPTURE(choice.samples.size());
    const auto problems = banks::registry().check<DiagnoserEntry>(
        choice.diagnoser, {choice.bank, banks::registry().make<BackendEntry>(choice.backend, {})},
        choice.params);
    if (!problems.empty()) {
      MESSAGE(choice.diagnoser, " on ", choice.backend, ": ", problems[0].message);
      continue;
    }
    std::vector<std::size_t> times;
    for (const std::size_t time : moments)
      if (time <= choice.samples.size()) times.push_back(time);
    check_going_on(trial_of(choice), times);
    seen.insert(choice.diagnoser);
  }
  CHECK(seen.size() == 4);
}

TEST_CASE("damaged states of diagnosers are refused, or lead somewhere") {
  std::uint64_t seed = 0;
  int refused = 0;
  for (const Named& choice : all_diagnosers()) {
    CAPTURE(choice.diagnoser);
    CAPTURE(choice.backend);
    const auto problems = banks::registry().check<DiagnoserEntry>(
        choice.diagnoser, {choice.bank, banks::registry().make<BackendEntry>(choice.backend, {})},
        choice.params);
    if (!problems.empty()) continue;
    const auto trial = trial_of(choice);
    const auto diagnoser = trial.make();
    const std::size_t time = choice.diagnoser == "tube_membership" ? 8 : 33;
    const std::size_t at_most = std::min(time, choice.samples.size() - 4);
    for (std::size_t at = 0; at < at_most; ++at) trial.step(*diagnoser, at);
    refused += check_damage(trial, trial.saved(*diagnoser), at_most, 60, ++seed);
  }
  CHECK(refused > 500);
}
