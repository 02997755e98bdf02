// SPDX-License-Identifier: GPL-3.0-or-later
// Components for tests of runs, registered in the process: a box backend that rests on the exchange
// form, a recursive observer, observers that misbehave, a diagnoser that says what it is told, and
// metrics.
#pragma once

#include <limits>
#include <memory>
#include <stdexcept>

#include "cordon/registry/registry.hpp"
#include "cordon/solvers/set_questions.hpp"
#include "cordon/study/run.hpp"
#include "run/design_components.hpp"
#include "run/fault_components.hpp"

namespace fakes {

using namespace cordon;

class BoxSet final : public Set {
 public:
  BoxSet(const SetBackend& backend, Box box) : Set(backend, box.dim()), box_(std::move(box)) {}

 private:
  Complexity do_complexity() const override { return {dim(), 0, 0}; }
  LineForm do_line_form() const override { return make_box(box_); }

  Box box_;
};

class BoxBackend final : public SetBackend {
 public:
  BoxBackend() : SetBackend({"box", true, false, true, Rounding::nominal, "boxes", ""}) {}

 private:
  Made do_import(const LineForm& X) const override {
    return {std::make_unique<BoxSet>(*this, cordon::interval_hull(X)), Tightness::outer};
  }
};

/// x_k ∈ A X ⊕ B u ⊕ Bw W, corrected by the output.
class Recursive : public Observer {
 public:
  explicit Recursive(const ObserverContext& context)
      : Observer(context.model, context.backend),
        W_(backend().import(model().W)),
        V_(backend().import(model().V)) {}

 protected:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    return X_ = corrected(X0 ? *X0 : backend().import(model().X0), first);
  }
  Enclosure do_step(const Sample& before, const Sample& now) override {
    const LinearModel& m = model().linear;
    const Term term{m.Bw, W_};
    const Enclosure next = timed(Phase::predict, [&] {
      return backend().predict(X_, {m.A, m.B * before.u, {&term, 1}});
    });
    return X_ = corrected(next, now);
  }
  void do_replace(const Enclosure& X) override { X_ = X; }

 private:
  Enclosure corrected(const Enclosure& X, const Sample& now) {
    const LinearModel& m = model().linear;
    return timed(Phase::correct, [&] {
      return backend().correct(X, {m.C, now.y - m.D * now.u, {m.Dv, V_}});
    });
  }

  Enclosure W_, V_, X_;
};

/// Offers two gains, and from k = 2 on an inner estimate: the hull of its estimate scaled by
/// `scale`, from k = 7 on by `later`; of one state too few if `cut`.
class Offering final : public Recursive {
 public:
  Offering(const ObserverContext& context, const Params& p)
      : Recursive(context), scale_(p.real("scale")), later_(p.real("later")), cut_(p.flag("cut")) {}

  std::vector<Gain> gains() const override {
    Gain designed{"upper_gain", "designed", Matrix{{.5}, {-.25}}, {}},
        given{"gain", "given", Matrix{{.5}, {0}}, {}};
    designed.certificate = {.75, Answer::yes, 2.5, 2.5, "γ", 2.5, 2.4375, .001};
    given.certificate.spectral_radius = 1.25;
    given.certificate.monotone = Answer::no;
    given.certificate.norm_lower = given.certificate.norm_upper =
        std::numeric_limits<double>::infinity();
    return {designed, given};
  }

 private:
  std::optional<Box> do_inner_estimate() const override {
    if (k_ < 2) return std::nullopt;
    const Box hull = X_.set->interval_hull();
    const Vector center = hull.center(), radius = (k_ < 7 ? scale_ : later_) * hull.radius();
    const Index n = hull.dim() - (cut_ ? 1 : 0);
    return Box{(center - radius).head(n), (center + radius).head(n)};
  }
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    return X_ = Recursive::do_start(X0, first);
  }
  Enclosure do_step(const Sample& before, const Sample& now) override {
    k_ = now.k;
    return X_ = Recursive::do_step(before, now);
  }

  double scale_, later_;
  bool cut_;
  Index k_ = 0;
  Enclosure X_;
};

/// Breaks down at k = 5, in one of several ways.
class Breaking final : public Observer {
 public:
  Breaking(const ObserverContext& context, std::string how)
      : Observer(context.model, context.backend), how_(std::move(how)) {}

 private:
  Enclosure do_start(const std::optional<Enclosure>&, const Sample&) override {
    return backend().space(model().linear.states());
  }
  Enclosure do_step(const Sample&, const Sample& now) override {
    if (now.k == 5 && how_ == "error")
      throw Error(Errc::unsupported, "out of \"order\",\nat k = 5");
    if (now.k == 5 && how_ == "exception") throw std::runtime_error("something else");
    if (now.k == 5 && how_ == "int") throw 5;
    return backend().space(model().linear.states());
  }
  void do_replace(const Enclosure&) override {}

  std::string how_;
};

/// Claims a small box around the origin from k = 3 on, whatever the data say; or ∅.
class Claiming final : public Observer {
 public:
  Claiming(const ObserverContext& context, double radius, double admissible)
      : Observer(context.model, context.backend), radius_(radius) {
    const Index n = model().linear.states();
    if (admissible > 0)
      admissible_ = make_box({Vector::Constant(n, -admissible), Vector::Constant(n, admissible)});
  }
  std::optional<LineForm> admissible_set() const override { return admissible_; }

 private:
  Enclosure do_start(const std::optional<Enclosure>&, const Sample&) override {
    return backend().space(model().linear.states());
  }
  Enclosure do_step(const Sample&, const Sample& now) override {
    const Index n = model().linear.states();
    if (now.k < 3) return backend().space(n);
    if (radius_ < 0) return backend().import(make_empty(n));
    return backend().box({Vector::Constant(n, -radius_), Vector::Constant(n, radius_)});
  }
  void do_replace(const Enclosure&) override {}

  double radius_;
  std::optional<LineForm> admissible_;
};

class Radius final : public Metric {
  std::vector<MetricValue> do_step(const StepView& view) override {
    largest_ = std::max(largest_, view.hull.longest_half_edge());
    return {{"radius", view.hull.longest_half_edge()},
            {"tightness", std::string("hidden")},
            {"k", Index{7}},
            {"assumed", std::string(view.assumptions_hold ? "yes" : "no")},
            {"missing", std::nan("")}};
  }
  std::vector<MetricValue> do_summary() const override { return {{"radius_max", largest_}}; }

  double largest_ = 0;
};

class Time final : public Metric {
  std::vector<MetricValue> do_step(const StepView& view) override {
    return {{"step_time", view.times.step()}};
  }
  std::vector<MetricValue> do_summary() const override { return {{"steps_timed", Index{1}}}; }
  bool do_reproducible() const override { return false; }
};

/// Changes the names of its values after the first step.
class Fickle final : public Metric {
  std::vector<MetricValue> do_step(const StepView& view) override {
    return {{view.estimate.k == 0 ? "a" : "b", 1.0}};
  }
  std::vector<MetricValue> do_summary() const override { return {}; }
};

/// Says what its script tells it, whatever the data are: `excludes` is contradicted, and the
/// nominal mode left, at `at`, one step later each time it is started again, and `mode` is isolated
/// at the step after. Breaks down at k = 5 of run number `breaks`.
class Scripted final : public Diagnoser {
 public:
  Scripted(const DiagnoserContext& context, const Params& script)
      : Diagnoser(context.bank, context.backend),
        at_(script.integer("at")),
        mode_(script.integer("mode")),
        excludes_(script.integer("excludes")),
        breaks_(script.integer("breaks")),
        promises_(script.flag("promises")) {}

 private:
  void do_start() override { ++runs_; }
  Diagnosis do_step(const Sample*, const Sample& now) override {
    if (runs_ == breaks_ && now.k == 5) throw Error(Errc::unsupported, "out of order");
    const Index at = at_ < 0 ? std::numeric_limits<Index>::max() - 1 : at_ + runs_ - 1;
    Diagnosis says;
    says.k = now.k;
    says.mode = bank().nominal;
    says.modes.resize(static_cast<std::size_t>(bank().size()));
    for (ModeEvidence& evidence : says.modes) {
      evidence.candidate = now.k == at;
      evidence.residual = {Vector::Constant(now.y.size(), -.25),
                           Vector::Constant(now.y.size(), .5)};
    }
    if (now.k >= at) {
      says.reset = now.k == at;
      says.since = says.reset ? 0 : at;
      says.decision = now.k == at ? Decision::isolating : Decision::monitoring;
      says.mode = now.k == at ? -1 : mode_;
      says.suggested = now.k == at ? mode_ : -1;
    }
    if (says.mode >= 0 && says.mode < bank().size())
      says.modes[static_cast<std::size_t>(says.mode)].candidate = true;
    if (now.k == at) {
      ModeEvidence& first = says.modes[static_cast<std::size_t>(excludes_)];
      first.consistent = Answer::no;
      first.residual = {Vector::Constant(now.y.size(), .125), Vector::Constant(now.y.size(), .5)};
      first.why = {Certificate::Kind::farkas, Vector::Ones(1), .125};
    }
    return says;
  }
  std::optional<Guarantees> do_guarantees() const override {
    if (!promises_) return std::nullopt;
    const Box inside{-Vector::Ones(1), Vector::Ones(1)},
        outside{Vector::Ones(1), 2 * Vector::Ones(1)};
    Guarantees found{"by hand",
                     {{0, 0, inside, Answer::yes}, {1, 0, outside, Answer::unknown}},
                     Answer::unknown,
                     {}};
    found.error_set = ErrorSetCheck{make_box(inside), false, .5, .25, 1, 0};
    return found;
  }

  Index at_, mode_, excludes_, breaks_, runs_ = 0;
  bool promises_;
};

inline void register_all(Registrar& registrar) {
  registrar.add(BackendEntry{{"box", "boxes", "", {}},
                             [](const Params&) { return std::make_unique<BoxBackend>(); }});
  const auto no_problem = [](const ObserverContext&, const Params&) {
    return std::vector<Diagnostic>{};
  };
  registrar.add(ObserverEntry{
      {"recursive", "predicts and corrects", "", {}},
      no_problem,
      [](const ObserverContext& c, const Params&) { return std::make_unique<Recursive>(c); }});
  ParamSchema how;
  how.choice("how", "way to break down", {"error", "exception", "int"}, "error");
  registrar.add(ObserverEntry{{"breaking", "breaks down", "", how},
                              no_problem,
                              [](const ObserverContext& c, const Params& p) {
                                return std::make_unique<Breaking>(c, p.text("how"));
                              }});
  ParamSchema offer;
  offer.real("scale", "of the inner estimate", .5, 0, 10);
  offer.real("later", "the same from k = 7 on", .5, 0, 10);
  offer.flag("cut", "leaves out a state", false);
  registrar.add(ObserverEntry{
      {"offering", "offers gains and an inner estimate", "", offer},
      no_problem,
      [](const ObserverContext& c, const Params& p) { return std::make_unique<Offering>(c, p); }});
  ParamSchema claim;
  claim.real("radius", "of the claimed box", 1e-3, -1, 1e9);
  claim.real("admissible", "radius of the admissible set; 0: none", 0, 0, 1e9);
  registrar.add(ObserverEntry{{"claiming", "claims a box", "", claim},
                              no_problem,
                              [](const ObserverContext& c, const Params& p) {
                                return std::make_unique<Claiming>(c, p.real("radius"),
                                                                  p.real("admissible"));
                              }});
  ParamSchema script;
  script.integer("at", "first k of the exclusion; -1: never", 10, -1, 1000000);
  script.integer("mode", "that is isolated", 1, 0, 100);
  script.integer("excludes", "mode that is contradicted", 0, 0, 2);
  script.integer("breaks", "number of the run that breaks down; 0: none", 0, 0, 1000);
  script.flag("promises", "makes statements in advance", true);
  script.set("admissible_set", "an assumption");
  script.set("other_set", "none");
  script.component("observer", "with assumptions of its own", "observer");
  const auto no_diagnoser_problem = [](const DiagnoserContext&, const Params&) {
    return std::vector<Diagnostic>{};
  };
  registrar.add(DiagnoserEntry{
      {"scripted", "says what it is told", "", script},
      no_diagnoser_problem,
      [](const DiagnoserContext& c, const Params& p) { return std::make_unique<Scripted>(c, p); }});
  register_bounding(registrar);
  register_designing(registrar);
  registrar.add(MetricEntry{{"radius", "half the longest edge", "", {}},
                            [](const Params&) { return std::make_unique<Radius>(); }});
  registrar.add(MetricEntry{{"time", "of a step", "", {}},
                            [](const Params&) { return std::make_unique<Time>(); }});
  registrar.add(MetricEntry{{"fickle", "changes its names", "", {}},
                            [](const Params&) { return std::make_unique<Fickle>(); }});
}

inline PipelineSpec pipeline(std::string name, std::string observer = "recursive",
                             Params params = {}) {
  return {{EstimationSpec{{std::move(observer), std::move(params)}}}, std::move(name), {"box", {}}};
}

inline PipelineSpec diagnosis(std::string name, Params params = {}) {
  return {{DiagnosisSpec{{"scripted", std::move(params)}}}, std::move(name), {"box", {}}};
}

/// A stable system of two states; its input drives the state away from the origin.
inline Study study(std::vector<PipelineSpec> pipelines, std::int64_t steps = 20) {
  Study s;
  s.file = "two_states.json";
  s.title = "two states";
  LinearModel& m = s.model.linear;
  m.A = Matrix{{.9, .1}, {0, .8}};
  m.B = Matrix{{0.}, {1.}};
  m.Bw = .1 * Matrix::Identity(2, 2);
  m.C = Matrix{{1., 0.}};
  m.D = Matrix::Zero(1, 1);
  m.Dv = Matrix{{.05}};
  s.model.X0 = s.model.W = make_box({-Vector::Ones(2), Vector::Ones(2)});
  s.model.V = make_box({-Vector::Ones(1), Vector::Ones(1)});
  SimulateSpec simulate;
  simulate.steps = steps;
  simulate.input.resize(1);
  simulate.input[0].offset = 1;
  s.data = simulate;
  s.pipelines = std::move(pipelines);
  s.metrics = {{"radius", {}}, {"time", {}}};
  s.resolved = R"({"cordon": 1, "title": "two states"})";
  return s;
}

/// The same with two additive faults and the diagnoser that knows of them.
inline Study study_with_faults(Params params, std::int64_t steps = 20) {
  PipelineSpec filter{{DiagnosisSpec{{"bounding", std::move(params)}}}, "filter", {"box", {}}};
  Study s = study({std::move(filter)}, steps);
  s.model.linear.F = Matrix::Identity(2, 2);
  return s;
}

}  // namespace fakes
