// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnoser `consistency_bank`: when modes are excluded, begin anew and are left alone. Partly with
// a puppet for an observer, whose estimates are what the sample says, partly with real observers on
// a plant that switches between modes with ranges.
#include <array>
#include <cmath>
#include <cstring>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "four_models.hpp"

using namespace cordon;
using namespace diagnosis_test;

namespace {

struct Trace {
  std::array<int, 4> steps{}, starts{};
  std::array<std::optional<Box>, 4> started_from;
};
Trace trace;

/// Observer of mode A(0,0): its estimate is ∅ where that entry of y is 1, and throws where it is 2.
class Puppet final : public Observer {
 public:
  explicit Puppet(const ObserverContext& context)
      : Observer(context.model, context.backend),
        mode_(static_cast<std::size_t>(context.model.linear.A(0, 0))) {}
  Tightness claim() const override { return Tightness::exact; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    ++trace.starts[mode_];
    trace.started_from[mode_] = X0 ? std::optional((*X0)->interval_hull()) : std::nullopt;
    return estimate(first);
  }
  Enclosure do_step(const Sample&, const Sample& now) override { return estimate(now); }
  void do_replace(const Enclosure&) override {}
  Enclosure estimate(const Sample& now) const {
    ++trace.steps[mode_];
    const double what = now.y[static_cast<Index>(mode_)];
    if (what == 2) throw Error(Errc::solver, "mode " + std::to_string(mode_));
    return what == 1 ? backend().empty(1) : backend().box(cube(1, 1));
  }
  std::size_t mode_;
};

void register_puppet(Registrar& registrar) {
  registrar.observer({{"puppet", "does what the sample says", "", {}},
                      {},
                      [](const ObserverContext& context, const Params&) {
                        return std::make_unique<Puppet>(context);
                      }});
}

ModeBank puppets() {
  ModeBank bank;
  for (int j = 0; j < 3; ++j) {
    Model model;
    LinearModel& m = model.linear;
    m.A = Matrix{{static_cast<double>(j)}};
    m.B = Matrix(1, 0);
    m.Bw = Matrix(1, 0);
    m.C = Matrix::Zero(3, 1);
    m.D = Matrix(3, 0);
    m.Dv = Matrix(3, 0);
    model.X0 = make_box(cube(1, 1));
    model.W = model.V = make_point(Vector(0));
    bank.modes.push_back({"mode_" + std::to_string(j), model});
  }
  return bank;
}

Params with_observer(const std::string& type, Params observer, std::int64_t waiting_time) {
  Params params;
  params.set("observer",
             std::make_shared<const ComponentSpec>(ComponentSpec{type, std::move(observer)}));
  params.set("waiting_time", waiting_time);
  return params;
}

/// Feeds samples, counting k.
class Feed {
 public:
  Feed(const Plugins& plugins, const std::string& backend, Params params)
      : diagnoser_(plugins.registry.make_diagnoser("consistency_bank", puppets(),
                                                   plugins.backend(backend), params)) {
    trace = {};
    diagnoser_->start();
  }
  Diagnosis operator()(double a, double b, double c) {
    return diagnoser_->step({k_++, Vector(0), Vector{{a, b, c}}});
  }
  void restart() {
    k_ = 0;
    diagnoser_->start();
  }

 private:
  std::shared_ptr<Diagnoser> diagnoser_;
  Index k_ = 7;
};

struct PuppetPlugins : Plugins {
  PuppetPlugins() { registry.add(register_puppet); }
};

std::vector<bool> candidates(const Diagnosis& d) {
  std::vector<bool> result;
  for (const ModeEvidence& evidence : d.modes) result.push_back(evidence.candidate);
  return result;
}

using Set3 = std::vector<bool>;

}  // namespace

TEST_CASE("modes are excluded one by one, and then cost nothing") {
  const PuppetPlugins plugins;
  Feed feed(plugins, "line_zonotope", with_observer("puppet", {}, 5));
  Diagnosis d = feed(0, 0, 0);
  CHECK(d.decision == Decision::isolating);
  CHECK(d.mode == -1);
  CHECK(d.since == 7);
  CHECK(candidates(d) == Set3{true, true, true});
  CHECK(!trace.started_from[0]);  // from its model's X0
  d = feed(0, 1, 0);
  CHECK(d.decision == Decision::isolating);
  CHECK(candidates(d) == Set3{true, false, true});
  CHECK(d.modes[1].consistent == Answer::no);
  CHECK(d.modes[1].why.kind == Certificate::Kind::farkas);
  CHECK(d.modes[0].consistent == Answer::yes);
  d = feed(1, 0, 0);
  CHECK(d.decision == Decision::monitoring);
  CHECK(d.mode == 2);
  REQUIRE(d.estimate);
  CHECK((*d.estimate)->dim() == 1);
  CHECK(d.modes[1].consistent == Answer::unknown);  // nothing was asked in this step
  CHECK(d.modes[1].why.kind == Certificate::Kind::none);
  feed(0, 0, 0);
  CHECK(trace.steps[0] == 3);
  CHECK(trace.steps[1] == 2);
  CHECK(trace.steps[2] == 4);
  // a second run begins anew
  feed.restart();
  d = feed(0, 0, 1);
  CHECK(candidates(d) == Set3{true, true, false});
  CHECK(d.since == 0);
}

TEST_CASE("a switch: every mode begins anew at the sample that excluded the last one") {
  const PuppetPlugins plugins;
  Params params = with_observer("puppet", {}, 3);
  params.set("restart_set", make_box(cube(1, 9))).set("start", std::string("nominal"));
  Feed feed(plugins, "constrained_zonotope", params);
  Diagnosis d = feed(0, 0, 0);
  CHECK(d.decision == Decision::monitoring);
  CHECK(d.mode == 0);
  CHECK(candidates(d) == Set3{true, false, false});
  CHECK(trace.starts == std::array<int, 4>{1, 0, 0, 0});
  d = feed(0, 1, 1);  // of no concern to the nominal mode
  CHECK(d.mode == 0);
  d = feed(1, 0, 0);
  CHECK(d.decision == Decision::isolating);
  CHECK(d.reset);
  CHECK(d.since == 7);  // the evidence is that of the time before
  CHECK(candidates(d) == Set3{true, true, true});
  CHECK(d.modes[0].consistent == Answer::no);
  CHECK(d.modes[1].consistent == Answer::unknown);
  CHECK(!d.estimate);
  CHECK(trace.starts == std::array<int, 4>{2, 1, 1, 0});
  CHECK(trace.started_from[1]->upper[0] == doctest::Approx(9));
  CHECK(trace.started_from[0]->lower[0] == doctest::Approx(-9));
  d = feed(0, 0, 1);
  // the sample of the reset contradicts mode 0 after the reset too
  CHECK(d.modes[0].consistent == Answer::no);
  CHECK(d.decision == Decision::monitoring);
  CHECK(!d.reset);
  CHECK(d.mode == 1);
  CHECK(d.since == 9);
}

TEST_CASE("every mode excluded: unknown_fault, until one mode has lasted") {
  const PuppetPlugins plugins;
  Feed feed(plugins, "line_zonotope", with_observer("puppet", {}, 3));
  feed(0, 0, 0);
  Diagnosis d = feed(1, 1, 1);
  CHECK(d.decision == Decision::unknown_fault);
  CHECK(d.reset);
  CHECK(d.since == 7);
  for (const ModeEvidence& evidence : d.modes) CHECK(evidence.consistent == Answer::no);
  CHECK(std::isinf(trace.started_from[0]->upper[0]));  // the whole space
  d = feed(0, 0, 0);  // the last sample alone contradicts every mode
  CHECK(d.decision == Decision::unknown_fault);
  CHECK(d.reset);
  CHECK(d.since == 8);
  d = feed(0, 1, 1);
  CHECK(d.decision == Decision::unknown_fault);  // one is left, but has not lasted
  CHECK(d.since == 9);
  CHECK(candidates(d) == Set3{true, false, false});
  CHECK(!d.estimate);
  feed(0, 0, 0);
  d = feed(0, 0, 0);
  CHECK(d.decision == Decision::monitoring);
  CHECK(d.mode == 0);
  CHECK(d.estimate);
}

TEST_CASE("on a bounded representation without a set to begin anew from, exclusions stay") {
  const PuppetPlugins plugins;
  for (const std::string backend : {"zonotope", "constrained_zonotope"}) {
    CAPTURE(backend);
    Feed feed(plugins, backend, with_observer("puppet", {}, 3));
    feed(0, 0, 0);
    Diagnosis d = feed(0, 1, 1);
    CHECK(d.decision == Decision::monitoring);
    d = feed(1, 0, 0);
    CHECK(d.decision == Decision::unknown_fault);
    CHECK(d.mode == -1);
    CHECK(!d.reset);
    CHECK(d.since == 7);
    CHECK(candidates(d) == Set3{false, false, false});
    d = feed(0, 0, 0);
    CHECK(d.decision == Decision::unknown_fault);
    CHECK(candidates(d) == Set3{false, false, false});
    CHECK(trace.steps == std::array<int, 4>{3, 2, 2, 0});
    feed.restart();
    CHECK(feed(0, 1, 1).decision == Decision::monitoring);
  }
}

TEST_CASE("a switch after a time of ambiguity is a switch, not an unknown fault") {
  const PuppetPlugins plugins;
  Feed feed(plugins, "line_zonotope", with_observer("puppet", {}, 2));
  feed(0, 0, 1);
  feed(0, 0, 0);
  Diagnosis d = feed(0, 0, 0);
  CHECK(d.decision == Decision::ambiguous);
  d = feed(1, 1, 0);
  CHECK(d.decision == Decision::isolating);
  CHECK(d.reset);
  d = feed(0, 0, 0);
  CHECK(d.decision == Decision::monitoring);
  CHECK(d.mode == 2);
  CHECK(d.since == 10);
}

TEST_CASE("an observer's error is that of the first mode, however many threads there are") {
  const PuppetPlugins plugins;
  for (const std::int64_t threads : {1, 3}) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      Params params = with_observer("puppet", {}, 2);
      params.set("threads", threads);
      Feed feed(plugins, "line_zonotope", params);
      feed(0, 0, 0);
      std::string what;
      try {
        feed(0, 2, 2);
      } catch (const Error& error) {
        what = error.what();
        CHECK(error.code() == Errc::solver);
      }
      CHECK(what == "mode 1");
    }
  }
}

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
    const auto diagnoser = plugins.registry.make_diagnoser(
        "consistency_bank", bank, plugins.backend(name), switching_parameters(name));
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
    const auto diagnoser = plugins.registry.make_diagnoser(
        "consistency_bank", bank, plugins.backend(name), switching_parameters(name));
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
      const auto diagnoser = plugins.registry.make_diagnoser(
          "consistency_bank", bank, plugins.backend(name), switching_parameters(name, threads));
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
    return plugins.registry.check_diagnoser("consistency_bank", bank, backend, params);
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
         plugins.registry.check_diagnoser("consistency_bank", bank, backend, params))
      all.push_back(p.pointer);
    return all;
  };
  using Pointers = std::vector<std::string>;
  CHECK(pointers(with_observer("prediction_correction", {}, 0)) == Pointers{"/waiting_time"});
  CHECK(pointers({}) == Pointers{"/observer", "/waiting_time"});
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
            .check_diagnoser("consistency_bank", bank, plugins.backend("line_zonotope"), nominal)
            .empty());
}

TEST_CASE("nothing is said in advance") {
  const Plugins plugins;
  const auto diagnoser = plugins.registry.make_diagnoser("consistency_bank", switching_bank(),
                                                         plugins.backend("zonotope"),
                                                         switching_parameters("zonotope"));
  CHECK(!diagnoser->guarantees());
}
