// SPDX-License-Identifier: GPL-3.0-or-later
// A small but honest plugin: boxes, an observer over any backend, and a metric.
#include <cmath>

#include "cordon/registry/plugin.hpp"

namespace {

using namespace cordon;

class TestBox final : public Set {
 public:
  TestBox(const SetBackend& backend, Box box) : Set(backend, box.dim()), box_(std::move(box)) {}

 private:
  Complexity do_complexity() const override { return {dim(), 0, 0}; }
  LineForm do_line_form() const override { return make_box(box_); }

  Box box_;
};

class TestBackend final : public SetBackend {
 public:
  explicit TestBackend(double growth)
      : SetBackend({.name = "test_box", .summary = "axis-aligned boxes", .citation = ""}),
        growth_(growth) {}

 private:
  /// The hull {c ± |G| 1}; constraints other than 0 = 1 are ignored, which encloses.
  Made do_import(const LineForm& X) const override {
    if (X.lines() > 0) throw Error(Errc::unsupported, "test_box holds bounded sets only");
    for (Index i = 0; i < X.constraints(); ++i) {
      if (X.A.row(i).isZero(0) && X.b[i] != 0)
        return {std::make_unique<TestBox>(*this, Box::empty(X.dim())), Tightness::exact};
    }
    const Vector radius = X.G.cwiseAbs().rowwise().sum() * (1 + growth_);
    bool is_box = X.constraints() == 0 && growth_ == 0;
    for (Index j = 0; j < X.generators(); ++j)
      is_box = is_box && (X.G.col(j).array() != 0).count() <= 1;
    return {std::make_unique<TestBox>(*this, Box{X.c - radius, X.c + radius}),
            is_box ? Tightness::exact : Tightness::outer};
  }

  double growth_;
};

/// X⁺ = A X ⊕ B u ⊕ Bw W, without corrections.
class OpenLoop final : public Observer {
 public:
  explicit OpenLoop(const ObserverContext& context)
      : Observer(context.model, context.backend), W_(backend().import(context.model.W)) {}

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample&) override {
    return X_ = X0 ? *X0 : backend().import(model().X0);
  }
  Enclosure do_step(const Sample& before, const Sample&) override {
    const LinearModel& m = model().linear;
    const Term noise{m.Bw, W_};
    return X_ = backend().predict(X_, {m.A, m.B * before.u, {&noise, 1}});
  }
  void do_replace(const Enclosure& X) override { X_ = X; }

  Enclosure W_, X_;
};

class StepCount final : public Metric {
  std::vector<MetricValue> do_step(const StepView&) override { return {{"steps", ++steps_}}; }
  std::vector<MetricValue> do_summary() const override { return {{"steps", steps_}}; }

  Index steps_ = 0;
};

void register_components(Registrar& registrar) {
  ParamSchema box;
  box.real("growth", "relative growth of every imported box, dimensionless", 0.0, 0.0, 1.0);
  registrar.add(BackendEntry{
      {"test_box", "axis-aligned boxes for tests", "", box},
      [](const Params& params) { return std::make_unique<TestBackend>(params.real("growth")); }});
  registrar.add(ObserverEntry{{"open_loop", "prediction without measurements", "", {}},
                              [](const ObserverContext& context, const Params&) {
                                std::vector<Diagnostic> problems;
                                if (context.model.linear.is_descriptor())
                                  problems.push_back({"", "needs a standard model", "leave out E"});
                                return problems;
                              },
                              [](const ObserverContext& context, const Params&) {
                                return std::make_unique<OpenLoop>(context);
                              }});
  registrar.add(MetricEntry{{"step_count", "number of steps", "", {}},
                            [](const Params&) { return std::make_unique<StepCount>(); }});
}

}  // namespace

CORDON_PLUGIN("test_box", "1.2.3", "GPL-3.0-or-later", "The Cordon authors", "boxes for tests",
              register_components)
