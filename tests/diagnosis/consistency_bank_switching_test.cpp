// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnoser `consistency_bank` with real observers on a plant that switches between modes with
// ranges, and what it refuses.
#include <cmath>

#include <doctest/doctest.h>

#include "four_models.hpp"
#include "with_observer.hpp"

using namespace cordon;
using namespace diagnosis_test;

namespace {

/// Two states, two actuators, two sensors: healthy, a weak first actuator, a dead second one, a
/// weak first sensor.
ModeBank switching_bank() {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.7, .2}, {-.2, .6}};
  m.B = Matrix{{1, .2}, {.3, 1}};
  m.Bw = Matrix::Identity(2, 2);
  m.C = Matrix{{1, .5}, {0, 1}};
  m.D = Matrix::Zero(2, 2);
  m.Dv = Matrix::Identity(2, 2);
  model.X0 = make_box(cube(2, 1));
  model.W = make_box(cube(2, .02));
  model.V = make_box(cube(2, .02));
  ModeBank bank;
  bank.modes.assign(4, {"healthy", model});
  const Vector one = Vector::Ones(2);
  bank.modes[1].name = "weak_actuator";
  bank.modes[1].model.linear.actuator = {Vector{{.2, 1}}, Vector{{.5, 1}}};
  bank.modes[2].name = "dead_actuator";
  bank.modes[2].model.linear.actuator = {Vector{{1, 0}}, one};
  bank.modes[2].model.linear.actuator.upper[1] = .1;
  bank.modes[3].name = "weak_sensor";
  bank.modes[3].model.linear.sensor = {Vector{{.4, 1}}, Vector{{.7, 1}}};
  return bank;
}

/// x_{k+1} and y_k are made with the mode of time k.
class SwitchingPlant {
 public:
  SwitchingPlant(std::uint64_t seed, bool vertex) : random_(seed), vertex_(vertex), x_(factors()) {}
  Sample step(const Model& mode) {
    const LinearModel& m = mode.linear;
    const double angle = .7 * static_cast<double>(k_);
    const Vector u{{2 * std::sin(angle) + 1, 2 * std::cos(1.3 * angle) - 1}};
    const Vector f = m.actuator_center() + m.actuator_radius().cwiseProduct(factors());
    const Vector g = m.sensor_center() + m.sensor_radius().cwiseProduct(factors());
    const Vector y = g.cwiseProduct(m.C * x_) + m.Dv * mode.V.G * factors();
    state = x_;
    x_ = m.A * x_ + m.B * f.cwiseProduct(u) + m.Bw * mode.W.G * factors();
    return {k_++, u, y};
  }
  Vector state;

 private:
  Vector factors() {
    const Vector xi = random_.cube(2);
    return vertex_ ? Vector((xi.array() < 0).select(Vector::Constant(2, -1), Vector::Ones(2))) : xi;
  }
  sets::Random random_;
  bool vertex_;
  Vector x_;
  Index k_ = 0;
};

Params switching_parameters(const std::string& backend, std::int64_t threads = 1) {
  Params observer;
  observer.set("max_generators", std::int64_t{20}).set("max_constraints", std::int64_t{5});
  Params params = with_observer("prediction_correction", observer, 20);
  params.set("start", std::string("nominal")).set("threads", threads);
  if (backend != "line_zonotope") params.set("restart_set", make_box(cube(2, 30)));
  return params;
}

constexpr Index segment = 30;
const std::vector<Index> timeline{0, 1, 0, 2, 3, 0};
Index mode_at(Index k) { return timeline[static_cast<std::size_t>(k / segment)]; }

}  // namespace

TEST_CASE("a plant that switches: the true mode is found each time and never excluded") {
  const Plugins plugins;
  const ModeBank bank = switching_bank();
  for (const std::string name : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(name);
    const auto diagnoser = plugins.registry.make<DiagnoserEntry>(
        "consistency_bank", {bank, plugins.backend(name)}, switching_parameters(name));
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      CAPTURE(seed);
      SwitchingPlant plant(seed, seed % 2 == 0);
      diagnoser->start();
      for (Index k = 0; k < segment * static_cast<Index>(timeline.size()); ++k) {
        CAPTURE(k);
        const Diagnosis d = diagnoser->step(plant.step(bank[mode_at(k)].model));
        const bool throughout =
            !d.reset &&
            d.since / segment == k / segment;  // the plant was in one mode from `since` to k
        if (throughout) REQUIRE(d.modes[static_cast<std::size_t>(mode_at(k))].candidate);
        if (k < segment) REQUIRE(d.mode == 0);
        if (d.mode == mode_at(k) && throughout)
          REQUIRE((*d.estimate)->contains(plant.state) != Answer::no);
        if (k % segment >= 20) REQUIRE(d.mode == mode_at(k));
        REQUIRE(d.decision != Decision::unknown_fault);
      }
    }
  }
}

TEST_CASE("a fault outside the bank: detected, never taken for a mode of the bank") {
  const Plugins plugins;
  const ModeBank bank = switching_bank();
  Model outside = bank[0].model;
  outside.linear.B *= -1;
  for (const std::string name : {"interval", "zonotope", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(name);
    const auto diagnoser = plugins.registry.make<DiagnoserEntry>(
        "consistency_bank", {bank, plugins.backend(name)}, switching_parameters(name));
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      CAPTURE(seed);
      SwitchingPlant plant(seed, seed % 2 == 0);
      diagnoser->start();
      Diagnosis d;
      for (Index k = 0; k < 60; ++k) {
        CAPTURE(k);
        d = diagnoser->step(plant.step(k < segment ? bank[0].model : outside));
        REQUIRE(d.mode <= 0);
        if (k >= segment + 10) REQUIRE(d.decision == Decision::unknown_fault);
      }
    }
  }
}

namespace {

/// Everything that a diagnosis says, bit by bit.
std::string bytes_of(const Diagnosis& d) {
  std::string all;
  const auto put = [&all](const void* data, std::size_t size) {
    all.append(static_cast<const char*>(data), size);
  };
  const auto put_vector = [&](const Vector& v) {
    put(v.data(), sizeof(double) * static_cast<std::size_t>(v.size()));
  };
  put(&d.decision, sizeof d.decision);
  put(&d.mode, sizeof d.mode);
  put(&d.since, sizeof d.since);
  for (const ModeEvidence& evidence : d.modes) {
    put(&evidence.candidate, sizeof evidence.candidate);
    put(&evidence.consistent, sizeof evidence.consistent);
    put(&evidence.why.margin, sizeof evidence.why.margin);
    put_vector(evidence.why.data);
  }
  if (d.estimate) {
    const LineForm form = (*d.estimate)->line_form();
    put_vector(form.c);
    put_vector(form.G.reshaped());
    put_vector(form.A.reshaped());
    put_vector(form.b);
  }
  return all;
}

}  // namespace

TEST_CASE("decisions do not depend on the number of threads, bit by bit") {
  const Plugins plugins;
  const ModeBank bank = switching_bank();
  for (const std::string name : {"zonotope", "line_zonotope"}) {
    std::vector<std::string> reference;
    for (const std::int64_t threads : {1, 2, 0, 7}) {
      CAPTURE(threads);
      const auto diagnoser = plugins.registry.make<DiagnoserEntry>(
          "consistency_bank", {bank, plugins.backend(name)}, switching_parameters(name, threads));
      SwitchingPlant plant(3, false);
      diagnoser->start();
      std::vector<std::string> all;
      for (Index k = 0; k < 4 * segment; ++k)
        all.push_back(bytes_of(diagnoser->step(plant.step(bank[mode_at(k)].model))));
      if (threads == 1) reference = all;
      CHECK(all == reference);
    }
  }
}

TEST_CASE("a problem of several modes is told once, with the names of the modes") {
  const Plugins plugins;
  const auto backend = plugins.backend("zonotope");
  const auto problems_of = [&](const ModeBank& bank, const Params& params) {
    return plugins.registry.check<DiagnoserEntry>("consistency_bank", {bank, backend}, params);
  };
  ModeBank bank = switching_bank();
  CHECK(problems_of(bank, with_observer("prediction_correction", {}, 5)).empty());

  Params small;
  small.set("max_generators", std::int64_t{1});
  auto problems = problems_of(bank, with_observer("prediction_correction", small, 5));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/observer/max_generators");
  CHECK(problems[0].message.find("weak_sensor") == std::string::npos);

  bank.modes[1].model.X0 = bank.modes[3].model.X0 = make_space(2);
  problems = problems_of(bank, with_observer("prediction_correction", {}, 5));
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].pointer == "/observer");
  CHECK(problems[0].message.find("(modes \"weak_actuator\", \"weak_sensor\")") !=
        std::string::npos);

  Params unknown;
  unknown.set("gain", 1.0);
  problems = problems_of(bank, with_observer("prediction_correction", unknown, 5));
  REQUIRE(!problems.empty());
  CHECK(problems[0].pointer == "/observer/gain");
}

TEST_CASE("parameters that cannot be are refused") {
  const Plugins plugins;
  const ModeBank bank = switching_bank();
  const auto backend = plugins.backend("zonotope");
  const auto pointers = [&](const Params& params) {
    std::vector<std::string> all;
    for (const auto& p :
         plugins.registry.check<DiagnoserEntry>("consistency_bank", {bank, backend}, params))
      all.push_back(p.pointer);
    return all;
  };
  using Pointers = std::vector<std::string>;
  CHECK(pointers(with_observer("prediction_correction", {}, 0)) == Pointers{"/waiting_time"});
  CHECK(pointers({}) == Pointers{"/observer"});
  Params params = with_observer("prediction_correction", {}, 5);
  params.set("restart_set", make_box(cube(3, 1)));
  CHECK(pointers(params) == Pointers{"/restart_set"});
  params.set("restart_set", make_space(2));
  CHECK(pointers(params) == Pointers{"/restart_set"});
  params.set("restart_set", make_empty(2));
  CHECK(pointers(params) == Pointers{"/restart_set"});
  params.set("restart_set", make_box(cube(2, 1)));
  CHECK(pointers(params).empty());
  params.set("threads", std::int64_t{-1});
  CHECK(pointers(params) == Pointers{"/threads"});
  Params nominal = with_observer("prediction_correction", {}, 5);
  nominal.set("start", std::string("nominal"));
  CHECK(pointers(nominal) == Pointers{"/restart_set"});  // the other modes could never begin
  CHECK(plugins.registry
            .check<DiagnoserEntry>("consistency_bank", {bank, plugins.backend("line_zonotope")},
                                   nominal)
            .empty());
}

TEST_CASE("nothing is said in advance") {
  const Plugins plugins;
  const auto diagnoser = plugins.registry.make<DiagnoserEntry>(
      "consistency_bank", {switching_bank(), plugins.backend("zonotope")},
      switching_parameters("zonotope"));
  CHECK(!diagnoser->guarantees());
}
