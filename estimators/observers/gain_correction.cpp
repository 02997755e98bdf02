// SPDX-License-Identifier: GPL-3.0-or-later
// A predicted set that is corrected by a gain, on any backend:
//   X̄_0 = X0,   X̄_k = A X̂_{k-1} ⊕ {B u_{k-1}} ⊕ Bw W
//   X̂_k = (I - Λ C) X̄_k ⊕ {Λ (y_k - D u_k)} ⊕ (-Λ Dv) V,   reduced to the budget.
// With y - D u = C x + Dv v every x is (I - Λ C) x + Λ (y - D u - Dv v): X̂ encloses for every Λ, of
// which only its size depends. The correction is the recursion of luenberger_recursion.hpp for a
// state that stays where it is, A = I and neither inputs nor disturbances, so that ranges of
// sensors, an interval C, missing outputs and rounding are dealt with as there. With one gain for
// all times and exact matrices both are one map (one_step_correction.hpp).
#include <cmath>

#include "components.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/interfaces/archive.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "observer_parameters.hpp"
#include "observers/at_rest.hpp"
#include "observers/corrected_recursion.hpp"
#include "observers/gained_recursion.hpp"
#include "observers/interval_spread.hpp"
#include "observers/one_step_correction.hpp"
#include "observers/present_outputs.hpp"

namespace cordon::estimators {

namespace {

/// Every predicted set but the first holds Bw W. Constraints leave it open how thick that is.
Matrix held_by_predictions(const Model& model) {
  if (model.W.constraints() + model.V.constraints() > 0) return {};
  return linalg::product(model.linear.Bw, invariant::enclosing_zonotope(model.W).G);
}

class GainCorrection final : public Observer {
 public:
  GainCorrection(const ObserverContext& context, const Params& params, const ObserverGain& gain)
      : Observer(context.model, context.backend),
        budget_(budget_from(params)),
        X0_(initial_set_from(model(), params)),
        recursion_(model(), backend()),
        step_(model().linear, 1, 1),
        first_(at_rest(model()), gain, context.backend, budget_),
        correction_(at_rest(model()), gain, context.backend, budget_, held_by_predictions(model())),
        is_one_step_(!correction_.is_time_varying() && OneStepCorrection::takes(model())),
        noise_(linalg::product(model().linear.Dv, invariant::enclosing_zonotope(model().V).G)
                   .cwiseAbs()
                   .rowwise()
                   .sum()) {
    if (params.has("admissible_set")) admit(params.set_form("admissible_set"), budget_);
  }

  LineForm initial_set() const override { return X0_; }
  std::vector<Gain> gains() const override { return {correction_.gain().gain}; }
  bool follows_its_sets() const override { return true; }
  bool takes_missing_outputs() const override { return true; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample& first) override {
    correction_.start();
    return X_ = corrected(first_, X0 ? *X0 : backend().import(X0_), first);
  }
  Enclosure do_step(const Sample& before, const Sample& now) override {
    if (is_one_step_) {
      const std::optional<Enclosure> next =
          timed(Phase::predict, [&] { return in_one_step(before.u, now); });
      if (next) return X_ = reduced(*next);
    }
    const Enclosure predicted =
        timed(Phase::predict, [&] { return recursion_.predicted(X_, step_, before.u); });
    return X_ = corrected(correction_, predicted, now);
  }
  void do_replace(const Enclosure& X) override { X_ = X; }
  void do_serialize(Archive& archive) override {
    archive.set(X_, model().states());
    archive(correction_);
  }

  /// Nothing where X has no bounds.
  std::optional<Enclosure> in_one_step(VectorIn u, const Sample& now) {
    const auto step = one_steps_.at(now, [&](const std::vector<Index>& present) {
      return std::make_shared<OneStepCorrection>(with_outputs(model(), present),
                                                 correction_.gain().gain.L(Eigen::all, present),
                                                 backend());
    });
    return now.is_complete() ? step->next(X_, u, now) : step->next(X_, u, without_missing(now));
  }

  Enclosure corrected(GainedRecursion& recursion, const Enclosure& X, const Sample& sample) {
    const std::optional<Sample> others = without_open_outputs(recursion, X, sample);
    const Sample& now = others ? *others : sample;
    const bool none = now.y.size() == static_cast<Index>(now.missing.size());
    const Enclosure narrowed =
        none ? X : timed(Phase::correct, [&] { return narrowed_by(recursion, X, now); });
    return reduced(narrowed);
  }

  Enclosure reduced(const Enclosure& X) {
    return timed(Phase::reduce, [&] { return backend().reduce(X, budget_); });
  }

  /// The sample without outputs of which nothing is known where X has no bounds, as those of a
  /// sensor whose factor lies in a range; nothing where there are none.
  static std::optional<Sample> without_open_outputs(const GainedRecursion& recursion,
                                                    const Enclosure& X, const Sample& now) {
    const Vector widths = recursion.complete().open_outputs(X, now.u);
    std::vector<Index> open;
    for (Index i = 0; i < widths.size(); ++i) {
      if (!std::isfinite(widths[i])) open.push_back(i);
    }
    if (open.empty()) return std::nullopt;
    return missing_outputs(now, open);
  }

  /// ∅ where an output is proven to contradict the prediction.
  Enclosure narrowed_by(GainedRecursion& recursion, const Enclosure& X, const Sample& now) const {
    const Box reach = reach_of(*X);
    Enclosure next = recursion.next(X, now, &reach);
    if (reach.is_empty() || !reach.is_bounded()) return next;
    const bool contradicts = now.is_complete()
                                 ? is_contradicted(recursion.used(), X, reach, now, noise_)
                                 : is_contradicted(recursion.used(), X, reach, without_missing(now),
                                                   noise_(present_outputs(now)));
    return contradicts ? backend().empty(model().states()) : next;
  }

  /// Is an output proven to lie outside C X + D u + Dv V? Not where the noise alone explains how
  /// far it is from that of the centre, which spares the set of all outputs.
  static bool is_contradicted(const LuenbergerRecursion& recursion, const Enclosure& X,
                              const Box& reach, const Sample& now, VectorIn noise) {
    const Vector missed = recursion.residual(reach.center(), now);
    if ((missed.cwiseAbs().array() <= noise.array()).all()) return false;
    const Vector size = reach.lower.cwiseAbs().cwiseMax(reach.upper.cwiseAbs());
    return excludes_zero(reach_of(*recursion.residual(X, now)), recursion.residual_size(size, now));
  }

  Budget budget_;
  LineForm X0_;
  Enclosure X_;
  CorrectedRecursion recursion_;  ///< of which the prediction is used
  StackStep step_;
  GainedRecursion first_, correction_;
  bool is_one_step_;  ///< where X has bounds, by `one_steps_`
  PerOutputs<OneStepCorrection> one_steps_;
  Vector noise_;  ///< half widths of Dv V
};

ComponentSpec following_kalman() { return {"kalman", Params().set("steady", false)}; }

std::vector<Diagnostic> check_gain_correction(const ObserverContext& context,
                                              const Params& params) {
  std::vector<Diagnostic> problems = check_common(context, params);
  const LinearModel& m = context.model.linear;
  if (m.is_descriptor()) {
    problems.push_back({"/type", "\"gain_correction\" takes systems of type \"lti\"",
                        "use the observer \"descriptor\""});
    return problems;
  }
  const bool grows = has_spread(m.C_radius) || has_spread(m.sensor_radius());
  if (problems.empty() && grows) check_bounded_start(context, params, problems);
  if (check_noises(context, problems))  // gains are designed for these sets
    check_observer_gain(context, params, "gain", following_kalman(), problems, GainForm::filter);
  return problems;
}

constexpr const char* gain_correction_details =
    "The predicted set X̄ = A X̂ ⊕ {B u} ⊕ Bw W becomes\n"
    "    X̂⁺ = (I - Λ C) X̄ ⊕ {Λ (y⁺ - D u⁺)} ⊕ (-Λ Dv) V,\n"
    "which holds the state for every gain Λ: the gain decides how large the set is. It uses the "
    "outputs of its time, without an\n"
    "intersection. Errors obey e⁺ = (I - Λ C) (A e + Bw w) - Λ Dv v, and gains are designed for "
    "this form, so that (I - Λ C) A\n"
    "is stable. \"kalman\", the default, follows the predicted set: of all Λ its estimate has the "
    "least sum of squares of\n"
    "generators; with \"steady\" it is one matrix for all times, as \"w_radius\", \"h_infinity\", "
    "\"poles\" and given ones are.\n"
    "The set is empty only where an output by itself is proven to lie outside C X̄ + D u + Dv V.";

}  // namespace

CORDON_COMPONENT(observer, gain_correction) {
  ParamSchema schema = common_parameters();
  add_admissible_set(schema);
  add_gain_parameter(schema, "gain",
                     "Λ, a matrix with a row per state and a column per output that makes (I - Λ "
                     "C) A stable, or a designer of one; absent: \"kalman\", which follows the "
                     "predicted set");
  registrar.add(ObserverEntry{
      {"gain_correction",
       "prediction by the model, correction by a gain; standard linear systems, any backend",
       "Wang2018a", std::move(schema), gain_correction_details},
      check_gain_correction,
      [](const ObserverContext& context, const Params& params) -> std::unique_ptr<Observer> {
        return std::make_unique<GainCorrection>(
            context, params,
            observer_gain(context, params, "gain", following_kalman(), GainForm::filter));
      },
      true,
      true});
}

}  // namespace cordon::estimators
