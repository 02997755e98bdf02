// SPDX-License-Identifier: GPL-3.0-or-later
// Prediction and correction for x⁺ = A x + B u + Bw w, y = C x + D u + Dv v on any backend:
//   X̂_0 = {x ∈ X0 : y_0 - D u_0 - C x ∈ Dv V}
//   X̄_k = A X̂_{k-1} ⊕ {B u_{k-1}} ⊕ Bw W,   X̂_k = {x ∈ X̄_k : y_k - D u_k - C x ∈ Dv V}, reduced to
//   the budget.
// Ranges of effectiveness and interval matrices: effectiveness.hpp.
// Exact with constrained and line zonotopes until a reduction bites; zonotopes intersect strip by
// strip, intervals contract.
#include <optional>

#include "components.hpp"
#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "observer_parameters.hpp"
#include "observers/effectiveness.hpp"
#include "observers/rounding_room.hpp"

namespace cordon::estimators {

namespace {

class PredictionCorrection final : public Observer {
 public:
  PredictionCorrection(const ObserverContext& context, const Params& params)
      : Observer(context.model, context.backend),
        budget_(budget_from(params)),
        X0_(initial_set_from(model(), params)),
        W_(backend().import(model().W)),
        disturbance_(linalg::product(model().linear.Bw, model().W.c)),
        thickness_(model().W, model().linear.Bw),
        effectiveness_(model(), backend()),
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
    const LinearModel& m = model().linear;
    const Enclosure predicted = timed(Phase::predict, [&] {
      const Matrix spread = effectiveness_.input_spread(m.B, before.u),
                   unit = Matrix::Identity(m.states(), m.states());
      const Enclosure open =
          effectiveness_.has_open_states() ? effectiveness_.open_states(X_, before.u) : Enclosure{};
      std::vector<Term> terms{{m.Bw, W_}};
      if (effectiveness_.has_input_ranges())
        terms.push_back({spread, effectiveness_.input_factors()});
      if (effectiveness_.has_open_states()) terms.push_back({unit, open});
      const bool as_set = effectiveness_.inputs_enter_as_sets() && m.inputs() > 0;
      const Enclosure u = as_set ? backend().point(before.u) : Enclosure{};
      if (as_set) terms.push_back({m.B, u});
      const Vector shift =
          as_set ? Vector(Vector::Zero(m.states())) : effectiveness_.input(m.B, before.u);
      const std::optional<RoundingRoom> room =
          m.inputs() > 0 && !as_set ? std::optional(room_of(shift, before.u)) : std::nullopt;
      if (room && room->is_needed()) terms.push_back(room->term());
      Enclosure next = backend().predict(X_, {m.A, shift, terms});
      if (effectiveness_.has_open_states()) next.tightness = Tightness::outer;
      return next;
    });
    return X_ = corrected(predicted, now);
  }

  void do_replace(const Enclosure& X) override { X_ = X; }

  /// For B u beside the center of Bw W.
  RoundingRoom room_of(const Vector& shift, VectorIn u) const {
    const Vector terms = effectiveness_.input_terms(model().linear.B, u) + disturbance_.cwiseAbs();
    return {backend(), shift + disturbance_, terms, thickness_};
  }

  Enclosure corrected(const Enclosure& X, const Sample& now) {
    const Enclosure narrowed =
        timed(Phase::correct, [&] { return effectiveness_.correct(X, model().linear.C, now); });
    return timed(Phase::reduce, [&] { return backend().reduce(narrowed, budget_); });
  }

  Budget budget_;
  LineForm X0_;
  Enclosure W_, X_;
  Vector disturbance_;   ///< center of Bw W
  Thickness thickness_;  ///< of Bw W
  Effectiveness effectiveness_;
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
