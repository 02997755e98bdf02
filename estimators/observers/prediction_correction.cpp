// SPDX-License-Identifier: GPL-3.0-or-later
// Prediction and correction for x⁺ = A x + B u + Bw w, y = C x + D u + Dv v on any backend:
//   X̂_0 = {x ∈ X0 : y_0 - D u_0 - C x ∈ Dv V}
//   X̄_k = A X̂_{k-1} ⊕ {B u_{k-1}} ⊕ Bw W,   X̂_k = {x ∈ X̄_k : y_k - D u_k - C x ∈ Dv V}, reduced to
//   the budget.
// Ranges of effectiveness and interval matrices: effectiveness.hpp.
// Exact with constrained and line zonotopes until a reduction bites; zonotopes intersect strip by
// strip, intervals contract.
#include "components.hpp"
#include "observer_parameters.hpp"
#include "observers/prediction.hpp"

namespace cordon::estimators {

namespace {

class PredictionCorrection final : public Observer {
 public:
  PredictionCorrection(const ObserverContext& context, const Params& params)
      : Observer(context.model, context.backend),
        budget_(budget_from(params)),
        X0_(initial_set_from(model(), params)),
        effectiveness_(model(), backend()),
        prediction_(model(), backend(), effectiveness_),
        recursion_(effectiveness_.recursion({&model().linear.B, &model().linear.D})) {
    if (params.has("admissible_set")) admit(params.set_form("admissible_set"), budget_from(params));
  }

  LineForm initial_set() const override { return X0_; }
  Tightness claim() const override { return recursion_; }
  bool follows_its_sets() const override { return true; }
  bool takes_missing_outputs() const override { return true; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    return X_ = corrected(X0 ? *X0 : backend().import(X0_), first);
  }

  Enclosure do_step(const Sample& before, const Sample& now) override {
    const Enclosure predicted =
        timed(Phase::predict, [&] { return prediction_.next(X_, before.u); });
    return X_ = corrected(predicted, now);
  }

  void do_replace(const Enclosure& X) override { X_ = X; }

  Enclosure corrected(const Enclosure& X, const Sample& now) {
    const Enclosure narrowed =
        timed(Phase::correct, [&] { return effectiveness_.correct(X, model().linear.C, now); });
    return timed(Phase::reduce, [&] { return backend().reduce(narrowed, budget_); });
  }

  Budget budget_;
  LineForm X0_;
  Enclosure X_;
  Effectiveness effectiveness_;
  Prediction prediction_;
  Tightness recursion_;
};

std::vector<Diagnostic> check_prediction_correction(const ObserverContext& context,
                                                    const Params& params) {
  std::vector<Diagnostic> problems = check_common(context, params);
  if (context.model.linear.is_descriptor()) {
    problems.push_back({"/type", "\"prediction_correction\" takes systems of type \"lti\"",
                        "use the observer \"descriptor\""});
  }
  return problems;
}

}  // namespace

CORDON_COMPONENT(observer, prediction_correction) {
  ParamSchema schema = common_parameters();
  add_admissible_set(schema);
  registrar.add(ObserverEntry{
      {"prediction_correction",
       "prediction by the model, correction by the measurement; standard linear systems, any "
       "backend",
       "Combastel2003; Scott2016", std::move(schema)},
      check_prediction_correction,
      [](const ObserverContext& context, const Params& params) -> std::unique_ptr<Observer> {
        return std::make_unique<PredictionCorrection>(context, params);
      },
      true,
      true});
}

}  // namespace cordon::estimators
