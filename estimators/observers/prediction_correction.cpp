// SPDX-License-Identifier: GPL-3.0-or-later
// Prediction and correction on any backend (corrected_recursion.hpp), reduced to the budget. Exact
// with constrained and line zonotopes until a reduction bites; zonotopes intersect strip by strip,
// intervals contract.
#include "components.hpp"
#include "cordon/interfaces/archive.hpp"
#include "observer_parameters.hpp"
#include "observers/corrected_recursion.hpp"

namespace cordon::estimators {

namespace {

class PredictionCorrection final : public Observer {
 public:
  PredictionCorrection(const ObserverContext& context, const Params& params)
      : Observer(context.model, context.backend),
        budget_(budget_from(params)),
        X0_(initial_set_from(model(), params)),
        recursion_(model(), backend()),
        step_(model().linear, 1, 1) {
    if (params.has("admissible_set")) admit(params.set_form("admissible_set"), budget_from(params));
  }

  LineForm initial_set() const override { return X0_; }
  Tightness claim() const override { return recursion_.claim(); }
  bool follows_its_sets() const override { return true; }
  bool takes_missing_outputs() const override { return true; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    return X_ = corrected(X0 ? *X0 : backend().import(X0_), first);
  }

  Enclosure do_step(const Sample& before, const Sample& now) override {
    const Enclosure predicted =
        timed(Phase::predict, [&] { return recursion_.predicted(X_, step_, before.u); });
    return X_ = corrected(predicted, now);
  }

  void do_replace(const Enclosure& X) override { X_ = X; }
  void do_serialize(Archive& archive) override { archive.set(X_, model().states()); }

  Enclosure corrected(const Enclosure& X, const Sample& now) {
    const Enclosure narrowed =
        timed(Phase::correct, [&] { return recursion_.corrected(X, step_, now); });
    return timed(Phase::reduce, [&] { return backend().reduce(narrowed, budget_); });
  }

  Budget budget_;
  LineForm X0_;
  CorrectedRecursion recursion_;
  StackStep step_;
  Enclosure X_;
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
