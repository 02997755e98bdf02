// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnoser `consistency_bank` with a puppet for an observer, whose estimates are what the sample
// says: when modes are excluded, begin anew and are left alone.
#include <array>
#include <cmath>

#include <doctest/doctest.h>

#include "cordon/core/error.hpp"
#include "four_models.hpp"
#include "with_observer.hpp"

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
  registrar.add(ObserverEntry{{"puppet", "does what the sample says", "", {}},
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

/// Feeds samples, counting k.
class Feed {
 public:
  Feed(const Plugins& plugins, const std::string& backend, Params params)
      : diagnoser_(plugins.registry.make<DiagnoserEntry>(
            "consistency_bank", {puppets(), plugins.backend(backend)}, params)) {
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
