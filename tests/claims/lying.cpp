// SPDX-License-Identifier: GPL-3.0-or-later
// A third party's plugin whose components say what is not so.
#include <cmath>
#include <limits>

#include "cordon/registry/plugin.hpp"

namespace {

using namespace cordon;

/// Answers with u = (3, 0, …, 0), and what its parameter tells is wrong with the answer. It
/// computes nothing.
class Lying final : public InputDesigner {
 public:
  Lying(const DesignerContext& context, const Params& params)
      : InputDesigner(context.bank, context.backend), params_(params) {}

 private:
  DesignOutcome do_design(DesignControl&) const override {
    const std::string& lie = params_.text("lie");
    DesignOutcome outcome;
    outcome.status = DesignStatus::feasible;
    outcome.horizon = lie == "horizon" ? 1 : params_.integer("horizon");
    outcome.epsilon = .1;
    if (lie == "infeasible") {
      outcome.status = DesignStatus::infeasible;
      return outcome;
    }
    InputDesign& best = outcome.best.emplace();
    best.u = Matrix::Zero(outcome.horizon + (lie == "length" ? 0 : 1), 1);
    best.u(0, 0) = params_.real("first");
    best.cost = std::abs(best.u(0, 0));
    best.pairs = {{0, 1, 1, .5, Answer::yes, {}}};
    if (lie == "certificate") best.pairs[0].why = {Certificate::Kind::farkas, Vector::Ones(7), 12};
    if (lie == "void_certificate")
      best.pairs[0].why = {Certificate::Kind::farkas, Vector::Ones(7), 0};
    if (lie == "point") best.pairs[0].why = {Certificate::Kind::point, Vector::Zero(7), 1};
    if (lie == "meet") best.pairs[0].disjoint = Answer::no;
    if (lie == "silent") best.pairs[0].disjoint = Answer::unknown;
    if (lie == "order") std::swap(best.pairs[0].i, best.pairs[0].j);
    if (lie == "nan") best.pairs[0].kappa_lower = std::nan("");
    best.empty = {Answer::no, lie == "empty" ? Answer::yes : Answer::no};
    best.outputs.assign(2, Box::empty(outcome.horizon + 1));
    if (lie == "bound") outcome.lower_bound = 2 * best.cost;
    if (lie == "optimal") {
      outcome.status = DesignStatus::optimal;
      outcome.lower_bound = best.cost;
    }
    if (lie == "given") outcome.status = DesignStatus::given;
    if (lie == "assumes") outcome.admissible_set = make_point(Vector::Zero(1));
    if (lie == "last") outcome.last_output_only = true;
    return outcome;
  }

  Params params_;
};

/// Prediction without measurements; `boast` says that this is all that can be known.
class OpenLoop final : public Observer {
 public:
  OpenLoop(const ObserverContext& context, bool boast)
      : Observer(context.model, context.backend), W_(backend().import(model().W)), boast_(boast) {}
  Tightness claim() const override { return boast_ ? Tightness::exact : Observer::claim(); }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample&) override {
    return X_ = X0 ? *X0 : backend().import(model().X0);
  }
  Enclosure do_step(const Sample& before, const Sample&) override {
    const Term noise{model().linear.Bw, W_};
    return X_ = backend().predict(X_, {model().linear.A, model().linear.B * before.u, {&noise, 1}});
  }
  void do_replace(const Enclosure& X) override { X_ = X; }

  Enclosure W_, X_;
  bool boast_;
};

/// x⁺ = 0.5 x + u + 0.01 x², y = x + 0.02 x³: no linear model.
class Bent final : public Plant {
  Index do_states() const override { return 1; }
  Index do_inputs() const override { return 1; }
  Index do_outputs() const override { return 1; }
  Vector do_next(Index, VectorIn x, VectorIn u) const override {
    return Vector{{.5 * x[0] + u[0] + .01 * x[0] * x[0]}};
  }
  Vector do_output(Index, VectorIn x, VectorIn) const override {
    return Vector{{x[0] + .02 * x[0] * x[0] * x[0]}};
  }
};

void register_components(Registrar& registrar) {
  ParamSchema lie;
  lie.choice(
      "lie", "what is wrong with the answer",
      {"nothing", "certificate", "void_certificate", "point", "meet", "silent", "order", "nan",
       "length", "horizon", "empty", "bound", "optimal", "given", "assumes", "last", "infeasible"},
      "nothing");
  lie.integer("horizon", "N", 2, 1, 1000).real("first", "u_0", 3, -1e9, 1e9);
  lie.set("input_set", "the set of every input").vector("first_input", "u_0, if it is decided");
  lie.choice("outputs", "what is compared", {"all", "last"}, "all")
      .real("epsilon", "of κ", .1, 0, 1);
  registrar.add(DesignerEntry{
      {"lying", "says what it is told", "", lie},
      [](const DesignerContext&, const Params&) { return std::vector<Diagnostic>{}; },
      [](const DesignerContext& c, const Params& p) { return std::make_unique<Lying>(c, p); }});
  ParamSchema boast;
  boast.flag("boast", "claims exact estimates", false);
  registrar.add(
      ObserverEntry{{"blind", "prediction without measurements", "", boast},
                    [](const ObserverContext&, const Params&) { return std::vector<Diagnostic>{}; },
                    [](const ObserverContext& c, const Params& p) {
                      return std::make_unique<OpenLoop>(c, p.flag("boast"));
                    }});
  registrar.add(PlantEntry{{"bent", "a scalar plant", "", {}},
                           [](const Params&) { return std::make_unique<Bent>(); }});
}

}  // namespace

CORDON_PLUGIN("lying", "1.0.0", "GPL-3.0-or-later", "The Cordon authors",
              "components that lie, for tests", register_components)
