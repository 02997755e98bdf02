// SPDX-License-Identifier: GPL-3.0-or-later
// The set-based observer of uncertain systems: the recursion of luenberger_recursion.hpp, whose
// sets are reduced before they are mapped, so that estimates are not. [Pourasghar2021,
// Proposition 3.1] (As printed, (7b) leaves out the absolute value of the centre in diag(rad(A)
// |c|), and loses the truth.)
#include "components.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/interfaces/archive.hpp"
#include "cordon/invariant/zonotope_enclosure.hpp"
#include "observer_parameters.hpp"
#include "observers/gained_recursion.hpp"
#include "observers/inner_envelope.hpp"
#include "observers/interval_spread.hpp"

namespace cordon::estimators {

namespace {

class ZonotopeUncertain final : public Observer {
 public:
  ZonotopeUncertain(const ObserverContext& context, const Params& params, ObserverGain gain)
      : Observer(context.model, context.backend),
        X0_(initial_set_from(model(), params)),
        recursion_(model(), std::move(gain), context.backend, budget_from(params)),
        limit_(recursion_.is_time_varying() ? 0 : params.real("widening_limit")),
        inner_(model(), recursion_.gain().gain.L, params) {
    if (params.has("admissible_set")) admit(params.set_form("admissible_set"), budget_from(params));
  }

  LineForm initial_set() const override { return X0_; }
  std::vector<Gain> gains() const override { return {recursion_.gain().gain}; }
  bool follows_its_sets() const override { return !limit_.is_set(); }
  bool takes_missing_outputs() const override { return true; }
  bool uses_outputs_of_its_time() const override { return false; }

 private:
  std::optional<Box> do_inner_estimate() const override { return inner_.hull(); }
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample&) override {
    X_ = X0 ? *X0 : backend().import(X0_);
    limit_.start(recursion_.complete(), X_);
    if (!X0) {
      inner_.start(X0_);
    } else if (X_->has_exact_form()) {
      inner_.start(X_->line_form());
    } else {
      inner_.end();
    }
    return estimate();
  }
  Enclosure do_step(const Sample& before, const Sample&) override {
    const Enclosure carried =
        timed(Phase::reduce, [&] { return limit_.apply(backend(), recursion_.reduced(X_)); });
    X_ = timed(Phase::predict, [&] { return recursion_.next(carried, before); });
    recursion_.tell(limit_, before);
    inner_.step(before);
    return estimate();
  }
  void do_replace(const Enclosure& X) override {
    X_ = X;
    limit_.start(recursion_.complete(), X);
    inner_.end();
  }
  void do_serialize(Archive& archive) override {
    archive.set(X_, model().states());
    archive(recursion_, inner_);
    limit_.serialize(archive, recursion_.complete());
  }
  /// Claimed outer: what the measurement of the same time says is left out.
  Enclosure estimate() const { return {X_.set, Tightness::outer}; }

  LineForm X0_;
  GainedRecursion recursion_;
  WideningLimit limit_;
  InnerEnvelope inner_;
  Enclosure X_;
};

std::vector<Diagnostic> check_zonotope_uncertain(const ObserverContext& context,
                                                 const Params& params) {
  std::vector<Diagnostic> problems = check_common(context, params);
  const LinearModel& m = context.model.linear;
  if (m.is_descriptor()) {
    problems.push_back({"/type", "\"zonotope_uncertain\" takes systems of type \"lti\"",
                        "use the observer \"descriptor\""});
    return problems;
  }
  const bool grows = has_spread(m.A_radius) || has_spread(m.C_radius) ||
                     has_spread(m.sensor_radius());  // with the magnitudes of the states
  if (problems.empty() && grows) check_bounded_start(context, params, problems);
  check_noises(context, problems);
  if (!problems.empty()) return problems;  // gains are designed for these sets
  check_observer_gain(context, params, "gain", steady_kalman(), problems);
  if (!problems.empty() || params.integer("inner_samples") == 0) return problems;
  InnerEnvelope::check(context, params, problems);
  if (observer_gain(context, params, "gain", steady_kalman()).designer->is_time_varying()) {
    problems.push_back({"/inner_samples",
                        "an inner estimate is made for a gain that does not vary in time",
                        "leave it out, or give another gain"});
  }
  return problems;
}

constexpr const char* zonotope_uncertain_details =
    "A zonotope <c, R>, reduced to <c, Ř> with max_generators columns, becomes\n"
    "    c⁺ = (A - L C) c + B u + L y,\n"
    "    R⁺ = [(A - L C) Ř, diag(rad(A) (|c| + |Ř| 1) + rad(B) |u|), Bw W, -L Dv V, -L diag(rad(C) "
    "(|c| + |Ř| 1))];\n"
    "other representations follow the same sum of sets. The estimate is this set before the next "
    "reduction, so that\n"
    "the budget bounds what is carried from step to step. It uses outputs up to k - 1. A gain that "
    "varies in time is\n"
    "that for <c, Ř>.";

}  // namespace

CORDON_COMPONENT(observer, zonotope_uncertain) {
  ParamSchema schema = common_parameters();
  add_admissible_set(schema);
  add_widening_limit(schema);
  add_gain_parameter(schema, "gain",
                     "output gain, with A - L C stable; absent: the steady gain \"kalman\"");
  InnerEnvelope::add_parameters(schema);
  registrar.add(ObserverEntry{
      {"zonotope_uncertain",
       "set recursion with an output gain; standard linear systems with interval matrices",
       "Pourasghar2021", std::move(schema), zonotope_uncertain_details},
      check_zonotope_uncertain,
      [](const ObserverContext& context, const Params& params) -> std::unique_ptr<Observer> {
        return std::make_unique<ZonotopeUncertain>(
            context, params, observer_gain(context, params, "gain", steady_kalman()));
      },
      true,
      true});
}

}  // namespace cordon::estimators
