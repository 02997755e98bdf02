// SPDX-License-Identifier: GPL-3.0-or-later
// Gains, metrics and plants, right ones and others.
#include <cmath>

#include "cordon/core/error.hpp"
#include "cordon/interfaces/plant_formulas.hpp"
#include "cordon/solvers/exact_modes.hpp"
#include "filter.hpp"

namespace component_mutants {

namespace {

// ---- gains ----

using Changed = void (*)(const Model& model, GainDesign& design);

/// L = 0 where A is stable by itself.
class NoGain final : public GainDesigner {
 public:
  explicit NoGain(Changed change) : change_(change) {}

 private:
  GainDesign do_design(const Model& model) const override {
    const LinearModel& m = model.linear;
    GainDesign design;
    design.gain.L = Matrix::Zero(m.states(), m.outputs());
    if (exact::is_schur(m.A, design.gain.L, m.C)) {
      design.feasible = Answer::yes;
      design.gain.certificate.spectral_radius = 1;
      design.gain.certificate.monotone =
          exact::is_nonnegative(m.A, design.gain.L, m.C) ? Answer::yes : Answer::no;
    } else {
      design.reason = "A is not stable";
    }
    change_(model, design);
    return design;
  }
  Changed change_;
};

void leaves_it(const Model&, GainDesign&) {}
void takes_any(const Model&, GainDesign& design) { design.feasible = Answer::yes; }
void says_no_why(const Model&, GainDesign& design) { design.reason.clear(); }
void shrinks_radius(const Model&, GainDesign& design) {
  design.gain.certificate.spectral_radius = 0.125;
}
void calls_monotone(const Model&, GainDesign& design) {
  design.gain.certificate.monotone = Answer::yes;
}
void shrinks_norm(const Model&, GainDesign& design) {
  design.gain.certificate.norm_lower = design.gain.certificate.norm_upper = 0.01;
}
void minds_units(const Model& model, GainDesign& design) {
  if (model.linear.C.cwiseAbs().maxCoeff() < 1) return;
  design = {};
  design.feasible = Answer::no;
  design.reason = "C is too large";
}
void wanders(const Model& model, GainDesign& design) {
  static double step = 0;
  step += 1e-12;
  if (model.linear.A.isZero(0)) design.gain.L.array() += step;
}

void add_gain(Registrar& registrar, const char* name, const char* laws, const char* defect,
              Changed change) {
  registrar.add(
      GainEntry{described<GainEntry>(name, laws, defect),
                [](const GainContext&, const Params&) { return std::vector<Diagnostic>{}; },
                [change](const Params&) -> std::unique_ptr<GainDesigner> {
                  return std::make_unique<NoGain>(change);
                }});
}

// ---- metrics ----

using Valued = double (*)(const StepView& view, Index steps);

class Width final : public Metric {
 public:
  Width(Valued value, const char* other_name) : value_(value), other_name_(other_name) {}

 private:
  std::vector<MetricValue> do_step(const StepView& view) override {
    ++steps_;
    last_ = value_(view, steps_);
    return {{steps_ > 1 ? other_name_ : "width", last_}};
  }
  std::vector<MetricValue> do_summary() const override { return {{"last_width", last_}}; }
  std::vector<Measure> do_measures() const override {
    Measure measure;
    measure.name = "last_width";
    measure.of = "width";
    measure.quantity = Measure::Quantity::length;
    return {measure};
  }
  Valued value_;
  const char* other_name_;
  Index steps_ = 0;
  double last_ = 0;
};

double width(const StepView& view, Index) {
  return view.hull.is_empty() ? 0.0 : 2 * view.hull.longest_half_edge();
}
double negative(const StepView& view, Index) { return -width(view, 0) - 1; }
double undefined(const StepView& view, Index) { return 0 * width(view, 0) / 0.0; }
double counting(const StepView&, Index) {
  static double calls = 0;
  return ++calls;
}

void add_metric(Registrar& registrar, const char* name, const char* laws, const char* defect,
                Valued value, const char* other_name = "width") {
  registrar.add(MetricEntry{described<MetricEntry>(name, laws, defect),
                            [value, other_name](const Params&) -> std::unique_ptr<Metric> {
                              return std::make_unique<Width>(value, other_name);
                            }});
}

// ---- plants ----

struct Law {
  double factor = 0.5, formula = 0.5;
  bool remembers = false, overflows = false;
};

class Tank final : public Plant {
 public:
  explicit Tank(Law law) : law_(law) {}

 private:
  Index do_states() const override { return 1; }
  Index do_inputs() const override { return 1; }
  Index do_outputs() const override { return 1; }
  Vector do_next(Index, VectorIn x, VectorIn u) const override {
    if (law_.remembers) level_ += x[0];
    if (law_.overflows) return Vector::Constant(1, x[0] / 0.0);
    return Vector::Constant(1, law_.factor * x[0] + u[0] + (law_.remembers ? level_ : 0));
  }
  Vector do_output(Index, VectorIn x, VectorIn) const override { return x; }
  std::optional<PlantFormulas> do_formulas(const PlantVariables& of) const override {
    return PlantFormulas{{law_.formula * of.x[0] + of.u[0]}, {of.x[0]}};
  }
  Law law_;
  mutable double level_ = 0;
};

void add_plant(Registrar& registrar, const char* name, const char* laws, const char* defect,
               Law law) {
  registrar.add(PlantEntry{
      described<PlantEntry>(name, laws, defect),
      [law](const Params&) -> std::unique_ptr<Plant> { return std::make_unique<Tank>(law); }});
}

}  // namespace

void add_gains(Registrar& r) {
  add_gain(r, "no_gain", "keeps all laws", "L = 0 where A is stable", leaves_it);
  add_gain(r, "takes_any", "breaks gain.stable", "L = 0 whatever A is", takes_any);
  add_gain(r, "says_no_why", "breaks gain.stable", "gives no reason", says_no_why);
  add_gain(r, "shrinks_radius", "breaks gain.certificate", "tells a spectral radius of 1/8",
           shrinks_radius);
  add_gain(r, "calls_monotone", "breaks gain.certificate", "tells that A - L C ≥ 0",
           calls_monotone);
  add_gain(r, "shrinks_norm", "breaks gain.certificate", "tells a norm of 0.01", shrinks_norm);
  add_gain(r, "minds_units", "breaks gain.units", "has none for outputs in small units",
           minds_units);
  add_gain(r, "wanders", "breaks gain.repeats", "moves from call to call", wanders);
}

void add_metrics(Registrar& r) {
  add_metric(r, "width", "keeps all laws", "the longest edge", width);
  add_metric(r, "negative_width", "breaks metric.ranges", "tells a width below 0", negative);
  add_metric(r, "undefined_width", "breaks metric.ranges", "tells NaN", undefined);
  add_metric(r, "renamed_width", "breaks metric.names", "calls later values otherwise", width,
             "breadth");
  add_metric(r, "counting_width", "breaks metric.repeats", "counts the calls of all of its kind",
             counting);
}

void add_plants(Registrar& r) {
  add_plant(r, "tank", "keeps all laws", "x⁺ = x/2 + u", {});
  add_plant(r, "remembering_tank", "breaks plant.function", "adds up the states that it has seen",
            {0.5, 0.5, true, false});
  add_plant(r, "overflowing_tank", "breaks plant.finite", "divides by 0", {0.5, 0.5, false, true});
  add_plant(r, "two_tanks", "breaks plant.formulas", "has formulas of another plant",
            {0.5, 0.75, false, false});
}

}  // namespace component_mutants
