// SPDX-License-Identifier: GPL-3.0-or-later
// The bank of observers on the published reactor, and its contract.
#include <doctest/doctest.h>

#include "banks.hpp"

using namespace cordon;
using namespace banks;

namespace {

struct Event {
  Index k;
  std::string what;
  Index mode;
  bool operator==(const Event&) const = default;
  friend std::ostream& operator<<(std::ostream& out, const Event& e) {
    return out << e.what << ' ' << e.mode << " at " << e.k;
  }
};

/// Changes of the decision.
void note(const Diagnosis& now, Decision& decision, Index& mode, std::vector<Event>& events) {
  if (now.decision == decision && now.mode == mode) return;
  if (now.decision == Decision::monitoring) {
    events.push_back({now.k, "isolated", now.mode});
  } else {
    events.push_back(
        {now.k,
         now.decision == Decision::isolating ? "detected" : std::string(to_string(now.decision)),
         mode});
  }
  decision = now.decision;
  mode = now.mode;
}

Vector sine(Index k, double phase = 0) {
  return Vector::Constant(
      1, 20 * std::sin(2 * std::numbers::pi * static_cast<double>(k) / 25 + phase));
}

/// A timeline of 150 steps with a fault from `from` to 49 steps later. The truth must never be
/// excluded.
std::vector<Event> reactor_events(Diagnoser& diagnoser, Index fault, double F, Index from,
                                  Draw draw, double phase = 0) {
  const ModeBank& bank = diagnoser.bank();
  const Vector magnitude = Vector::Constant(1, F);
  Vector x = Vector::Zero(2);
  std::vector<Event> events;
  Decision decision = Decision::monitoring;
  Index mode = 0;
  Index truth_since = 0;
  diagnoser.start();
  for (Index k = 0; k <= 150; ++k) {
    const bool faulty = k >= from && k <= from + 49;
    const Index truth = faulty ? fault : 0;
    if (k == from || k == from + 50) truth_since = k;
    const Vector u = sine(k, phase), now = x;
    const Vector y = simulate(bank[truth].model, x, u, draw, faulty ? &magnitude : nullptr);
    const Diagnosis diagnosis = diagnoser.step({k, u, y});
    if (diagnosis.since >= truth_since) {
      CHECK_MESSAGE(diagnosis.modes[static_cast<std::size_t>(truth)].consistent != Answer::no,
                    "the true mode is excluded at ", k);
      if (diagnosis.estimate && diagnosis.mode == truth)
        CHECK((*diagnosis.estimate)->contains(now) != Answer::no);
    }
    note(diagnosis, decision, mode, events);
  }
  return events;
}

std::shared_ptr<Diagnoser> reactor_bank(const std::string& name,
                                        Params parameters = reactor_parameters()) {
  return registry().make<DiagnoserEntry>("observer_bank", {reactor(), backend(name)}, parameters);
}

std::vector<Event> published(Index fault, Index shift) {
  return {{51 + shift, "detected", 0},
          {52 + shift, "isolated", fault},
          {101 + shift, "detected", fault},
          {102 + shift, "isolated", 0}};
}

}  // namespace

TEST_CASE("reactor: detection and isolation one step apart, recovery too, on 60 seeds") {
  const auto bank = reactor_bank("zonotope");
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    for (const Index shift : {0, 1}) {
      CHECK(reactor_events(*bank, 1, .15, 50 + shift, {std::mt19937_64(seed)}) ==
            published(1, shift));
      CHECK(reactor_events(*bank, 2, .55, 50 + shift, {std::mt19937_64(seed)}) ==
            published(2, shift));
    }
  }
}

TEST_CASE("reactor: no false alarm with the disturbance at a vertex throughout, 32 cases") {
  const auto bank = reactor_bank("zonotope");
  for (int vertex = 0; vertex < 4; ++vertex) {
    for (int part = 0; part < 8; ++part) {
      CAPTURE(vertex);
      CAPTURE(part);
      ModeBank plant = reactor();
      for (Mode& mode : plant.modes) {
        const Vector signs{{vertex & 1 ? 1.0 : -1.0, vertex & 2 ? 1.0 : -1.0}};
        mode.model.W = make_point(mode.model.W.c + mode.model.W.G * signs);
      }
      const double phase = 2 * std::numbers::pi * part / 8;
      Vector x = Vector::Zero(2);
      Draw draw{std::mt19937_64(1)};
      Decision decision = Decision::monitoring;
      Index mode = 0;
      std::vector<Event> events;
      bank->start();
      for (Index k = 0; k <= 150; ++k) {
        const bool faulty = k >= 50 && k < 100;
        const Vector magnitude = Vector::Constant(1, .15), u = sine(k, phase);
        const Vector y =
            simulate(plant.modes[faulty ? 1 : 0].model, x, u, draw, faulty ? &magnitude : nullptr);
        note(bank->step({k, u, y}), decision, mode, events);
      }
      REQUIRE(events.size() == 4);  // each change detected and isolated once, and nothing else
      CHECK(events[1].mode == 1);
      CHECK(events[3].mode == 0);
    }
  }
}

TEST_CASE("the suggestion of the published algorithm names the fault too") {
  const auto bank = reactor_bank("zonotope");
  Vector x = Vector::Zero(2);
  Draw draw{std::mt19937_64(3)};
  Index suggested = -1;
  for (Index k = 0; k <= 80; ++k) {
    const Vector magnitude = Vector::Constant(1, .15), u = sine(k);
    const Vector y =
        simulate(bank->bank()[k >= 50 ? 1 : 0].model, x, u, draw, k >= 50 ? &magnitude : nullptr);
    suggested = bank->step({k, u, y}).suggested;
    CHECK((suggested == -1 || suggested == 1));
  }
  CHECK(suggested == 1);
}

TEST_CASE("a fault outside the bank ends as an unknown fault") {
  ModeBank plant = reactor();
  Model outside = plant[0].model;
  for (const double center : {-.03, .06}) {
    outside.W = box_around(Vector::Constant(2, center), Vector::Constant(2, .001));
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      CAPTURE(seed);
      const auto bank = reactor_bank("zonotope");
      Vector x = Vector::Zero(2);
      Draw draw{std::mt19937_64(seed)};
      Diagnosis last;
      for (Index k = 0; k <= 120; ++k) {
        const Vector u = sine(k);
        const Vector y = simulate(k >= 50 ? outside : plant[0].model, x, u, draw);
        last = bank->step({k, u, y});
        if (k > 60) CHECK(last.decision == Decision::unknown_fault);
      }
      CHECK(last.decision == Decision::unknown_fault);
    }
  }
}

TEST_CASE("after an unknown fault the healthy plant is recognised again") {
  const auto bank = reactor_bank("zonotope");
  Model outside = reactor()[0].model;
  outside.W = box_around(Vector::Constant(2, -.03), Vector::Constant(2, .001));
  Vector x = Vector::Zero(2);
  Draw draw{std::mt19937_64(5)};
  Diagnosis last;
  for (Index k = 0; k <= 150; ++k) {
    const Vector u = sine(k);
    const Vector y = simulate(k >= 50 && k < 80 ? outside : bank->bank()[0].model, x, u, draw);
    last = bank->step({k, u, y});
    if (k == 79) CHECK(last.decision == Decision::unknown_fault);
  }
  CHECK(last.decision == Decision::monitoring);
  CHECK(last.mode == 0);
}

TEST_CASE("threads change nothing, to the last bit") {
  for (const char* name : {"zonotope", "constrained_zonotope"}) {
    Params parallel = reactor_parameters();
    parallel.set("threads", std::int64_t{3});
    const auto one = reactor_bank(name), many = reactor_bank(name, parallel);
    Vector x = Vector::Zero(2);
    Draw draw{std::mt19937_64(7)};
    for (Index k = 0; k <= 110; ++k) {
      const Vector u = sine(k);
      const Vector y = simulate(one->bank()[k >= 50 && k < 100 ? 2 : 0].model, x, u, draw);
      const Diagnosis a = one->step({k, u, y}), b = many->step({k, u, y});
      REQUIRE(a.decision == b.decision);
      REQUIRE(a.mode == b.mode);
      REQUIRE(a.suggested == b.suggested);
      for (std::size_t j = 0; j < 3; ++j) {
        REQUIRE(a.modes[j].consistent == b.modes[j].consistent);
        REQUIRE(a.modes[j].residual.lower == b.modes[j].residual.lower);
        REQUIRE(a.modes[j].residual.upper == b.modes[j].residual.upper);
        REQUIRE(a.modes[j].why.margin == b.modes[j].why.margin);
      }
    }
  }
}

TEST_CASE("every backend runs the same diagnosis") {
  for (const char* name : {"interval", "constrained_zonotope", "line_zonotope"}) {
    CAPTURE(name);
    const auto bank = reactor_bank(name);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const std::vector<Event> events = reactor_events(*bank, 1, .15, 50, {std::mt19937_64(seed)});
      REQUIRE(events.size() >= 2);
      CHECK(events[0].what == "detected");
      CHECK(events[1].mode == 1);
    }
  }
}

TEST_CASE("evidence is offered about candidates alone") {
  const auto bank = reactor_bank("zonotope");
  Vector x = Vector::Zero(2);
  Draw draw{std::mt19937_64(1)};
  for (Index k = 0; k <= 70; ++k) {
    const Vector u = sine(k), y = simulate(bank->bank()[k >= 50 ? 1 : 0].model, x, u, draw);
    const Diagnosis diagnosis = bank->step({k, u, y});
    for (std::size_t j = 0; j < 3; ++j) {
      const bool expected = k <= 51 ? j == 0 : k == 52 || j == 1;  // detected at 51, isolated at 52
      if (!expected) CHECK(diagnosis.modes[j].consistent == Answer::unknown);
      CHECK((diagnosis.modes[j].reset_residual.dim() > 0) == (k > 51 && expected));
    }
  }
}

TEST_CASE("an exclusion carries its proof") {
  const auto bank = reactor_bank("zonotope");
  Vector x = Vector::Zero(2);
  Draw draw{std::mt19937_64(1)};
  for (Index k = 0; k <= 51; ++k) {
    const Vector magnitude = Vector::Constant(1, .15), u = sine(k);
    const Vector y =
        simulate(bank->bank()[k >= 50 ? 1 : 0].model, x, u, draw, k >= 50 ? &magnitude : nullptr);
    const Diagnosis diagnosis = bank->step({k, u, y});
    if (k < 51) continue;
    const ModeEvidence& healthy = diagnosis.modes[0];
    CHECK(diagnosis.reset);
    CHECK(diagnosis.since == 0);
    CHECK(healthy.consistent == Answer::no);
    CHECK(healthy.candidate);  // a candidate again, after the reset
    REQUIRE(healthy.why.kind == Certificate::Kind::direction);
    const double d = healthy.why.data[0];
    CHECK(std::max(d * healthy.residual.lower[0], d * healthy.residual.upper[0]) ==
          doctest::Approx(-healthy.why.margin));
    CHECK(healthy.why.margin > 0);
  }
}

namespace {

std::vector<Diagnostic> problems(const Params& parameters, const ModeBank& bank = reactor(),
                                 const std::string& name = "zonotope") {
  return registry().check<DiagnoserEntry>("observer_bank", {bank, backend(name)}, parameters);
}

bool has(const std::vector<Diagnostic>& all, const std::string& pointer, const std::string& text) {
  return std::any_of(all.begin(), all.end(), [&](const Diagnostic& d) {
    return d.pointer == pointer && (d.message + " " + d.suggestion).find(text) != std::string::npos;
  });
}

}  // namespace

TEST_CASE("what is wrong with a bank is said before it runs") {
  CHECK(problems(reactor_parameters()).empty());
  Params p = reactor_parameters();
  p.set("gain", Matrix{{2.5}, {0}});
  CHECK(has(problems(p), "/gain", "-1.6"));  // the eigenvalue
  CHECK(problems(p).size() == 1);            // one gain, one loop: told once
  p = reactor_parameters().set("gain", Matrix{{.1582, 11.6106}});
  CHECK(has(problems(p), "/gain", "is 1 × 2, must be 2 × 1"));
  p = reactor_parameters().set("gains", std::vector<Matrix>{Matrix{{.1582}, {11.6106}}});
  CHECK(has(problems(p), "/gains", "remove one of the two"));
  CHECK(has(problems(p), "/gains", "holds 1 matrices, the bank has 3 modes"));
  p = reactor_parameters().set("waiting_time", std::int64_t{0});
  CHECK(has(problems(p), "/waiting_time", "must lie in [1"));
  Params without;
  without.set("gain", Matrix{{.1582}, {11.6106}});
  CHECK(problems(without).empty());  // 1: nothing is assumed
  p = reactor_parameters().set("strip_gain", Matrix{{1}});
  CHECK(has(problems(p), "/strip_gain", "must be 2 × 1"));
  p = reactor_parameters().set("iterations", Vector{{1.5}});
  CHECK(has(problems(p), "/iterations", "whole numbers"));
  ModeBank unbounded = reactor();
  for (Mode& mode : unbounded.modes) mode.model.U = make_space(1);
  CHECK(has(problems(reactor_parameters(), unbounded), "", "U"));
}

TEST_CASE("the published error set is too small, and refused with the factor") {
  Params p = reactor_parameters();
  p.set("error_set", make_zonotope(Vector::Zero(2), Matrix{{.15, 0, .15}, {0, 5, 5}}));
  const auto found = problems(p);
  CHECK(has(found, "/error_set", "1.16"));
  CHECK_THROWS_AS(reactor_bank("zonotope", p), InputError);
}

TEST_CASE("an input has to lie in the U of every mode") {
  for (const std::size_t narrow : {0, 2}) {
    ModeBank modes = reactor();
    modes.modes[narrow].model.U = box_around(Vector::Zero(1), Vector::Constant(1, 10));
    const auto bank = registry().make<DiagnoserEntry>("observer_bank", {modes, backend("zonotope")},
                                                      reactor_parameters());
    for (const double u : {-15.0, 15.0})
      CHECK_THROWS_AS(bank->step({0, Vector::Constant(1, u), Vector::Zero(1)}), Error);
    CHECK(bank->step({0, Vector::Constant(1, 10), Vector::Zero(1)}).mode == 0);
  }
}

TEST_CASE("an input outside U ends the diagnosis: the error set rests on it") {
  const auto bank = reactor_bank("zonotope");
  CHECK_THROWS_WITH_AS(bank->step({0, Vector::Constant(1, 21), Vector::Zero(1)}),
                       doctest::Contains("widen /system/U"), Error);
}

TEST_CASE("a step that ended with an error is not taken twice") {
  const auto bank = reactor_bank("zonotope");
  const Vector u = Vector::Zero(1), y = Vector::Zero(1);
  bank->step({0, u, y});
  CHECK_THROWS_AS(bank->step({1, Vector::Constant(1, 21), y}), Error);  // nothing has happened yet
  bank->step(
      {1, u,
       Vector::Constant(1, 1e308)});  // its consequences overflow half way through the next one
  CHECK_THROWS_AS(bank->step({2, u, y}), Error);
  CHECK_THROWS_WITH_AS(bank->step({2, u, y}), doctest::Contains("start anew"), Error);
  bank->start();
  CHECK(bank->step({0, u, y}).mode == 0);
}

TEST_CASE("a measurement that no error explains empties the copies, and the proof says so") {
  const auto bank = reactor_bank("constrained_zonotope", [] {
    Params p;  // no strip gain: the backend intersects exactly
    p.set("gain", Matrix{{.1582}, {11.6106}}).set("waiting_time", std::int64_t{20});
    return p;
  }());
  const Vector u = Vector::Zero(1);
  bank->step({0, u, Vector::Constant(1, 100)});  // far outside: the healthy mode is excluded, and
                                                 // nothing in the error set fits
  const Diagnosis next = bank->step({1, u, Vector::Zero(1)});
  for (const ModeEvidence& evidence : next.modes) {
    CHECK(evidence.consistent == Answer::no);
    CHECK(evidence.why.kind == Certificate::Kind::farkas);
    CHECK(evidence.reset_residual.dim() == 0);
  }
  CHECK(next.decision == Decision::unknown_fault);
}

TEST_CASE(
    "samples that are not numbers, not of the model or out of order are refused, and change "
    "nothing") {
  const auto bank = reactor_bank("zonotope");
  const Vector u = Vector::Zero(1), y = Vector::Zero(1);
  bank->step({0, u, y});
  CHECK_THROWS_AS(bank->step({1, u, Vector::Constant(1, std::nan(""))}), Error);
  CHECK_THROWS_AS(bank->step({1, Vector::Constant(1, INFINITY), y}), Error);
  CHECK_THROWS_AS(bank->step({1, u, Vector::Zero(2)}), Error);
  CHECK_THROWS_AS(bank->step({3, u, y}), Error);
  CHECK(bank->step({1, u, y}).decision == Decision::monitoring);
}

TEST_CASE("a plant that starts in the X0 of another mode is of that mode") {
  Model model;
  LinearModel& m = model.linear;
  m.A = Matrix{{.5}};
  m.B = m.D = Matrix::Zero(1, 1);
  m.Bw = m.C = m.Dv = Matrix{{1}};
  model.X0 = box_around(Vector{{0}}, Vector{{1}});
  model.W = model.V = box_around(Vector{{0}}, Vector{{.1}});
  model.U = box_around(Vector{{0}}, Vector{{1}});
  ModeBank modes;
  modes.modes.push_back({"healthy", model});
  model.X0 = box_around(Vector{{650}}, Vector{{250}});
  model.W = box_around(Vector{{3}}, Vector{{.1}});
  modes.modes.push_back({"other", model});
  for (const char* name : {"zonotope", "interval", "line_zonotope"}) {
    CAPTURE(name);
    Params p;
    p.set("gain", Matrix{{.25}}).set("waiting_time", std::int64_t{5});
    const auto bank = registry().make<DiagnoserEntry>("observer_bank", {modes, backend(name)}, p);
    CHECK(bank->guarantees()->error_set->set.G.cwiseAbs().sum() > 400);
    for (const double x0 : {400., 650., 900.}) {
      double x = x0;
      bank->start();
      for (Index k = 0; k < 30; ++k, x = .5 * x + 3) {
        const Diagnosis now = bank->step({k, Vector{{0}}, Vector{{x}}});
        CHECK(now.modes[1].consistent != Answer::no);
      }
    }
  }
}
