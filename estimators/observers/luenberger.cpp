// SPDX-License-Identifier: GPL-3.0-or-later
// The Luenberger observer on sets, for x⁺ = A x + B f u + Bw w on any backend: X̂_0 = X0, then the
// recursion of luenberger_recursion.hpp, reduced to the budget, with one gain for all times or with
// one for the covariation of each X̂_k. Its estimate at k uses the outputs up to k - 1 and is never
// empty; that an output contradicts it shows in the residual set, which the diagnoser
// "observer_bank" watches.
#include "components.hpp"
#include "cordon/interfaces/archive.hpp"
#include "observer_parameters.hpp"
#include "observers/gained_recursion.hpp"
#include "observers/interval_spread.hpp"

namespace cordon::estimators {

namespace {

/// Claims no exact estimate: a measurement enters by a gain, one step late.
class Luenberger final : public Observer {
 public:
  Luenberger(const ObserverContext& context, const Params& params)
      : Observer(context.model, context.backend),
        X0_(initial_set_from(model(), params)),
        recursion_(model(), observer_gain(context, params, "gain", steady_kalman()),
                   context.backend, budget_from(params)),
        limit_(recursion_.is_time_varying() ? 0 : params.real("widening_limit")) {
    if (params.has("admissible_set")) admit(params.set_form("admissible_set"), budget_from(params));
  }

  LineForm initial_set() const override { return X0_; }
  std::vector<Gain> gains() const override { return {recursion_.gain().gain}; }
  bool follows_its_sets() const override { return !limit_.is_set(); }
  bool takes_missing_outputs() const override { return true; }
  bool uses_outputs_of_its_time() const override { return false; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample&) override {
    const Enclosure start = X0 ? *X0 : backend().import(X0_);
    limit_.start(recursion_.complete(), start);
    return X_ = timed(Phase::reduce, [&] { return recursion_.reduced(start); });
  }
  Enclosure do_step(const Sample& before, const Sample&) override {
    const Enclosure next = timed(Phase::predict, [&] { return recursion_.next(X_, before); });
    X_ = timed(Phase::reduce, [&] {
      recursion_.tell(limit_, before);
      return limit_.apply(backend(), recursion_.reduced(next));
    });
    return X_;
  }
  void do_replace(const Enclosure& X) override {
    X_ = X;
    limit_.start(recursion_.complete(), X);
  }
  void do_serialize(Archive& archive) override {
    archive.set(X_, model().states());
    archive(recursion_);
    limit_.serialize(archive, recursion_.complete());
  }

  LineForm X0_;
  GainedRecursion recursion_;
  WideningLimit limit_;
  Enclosure X_;
};

std::vector<Diagnostic> check_luenberger(const ObserverContext& context, const Params& params) {
  std::vector<Diagnostic> problems = check_common(context, params);
  const LinearModel& m = context.model.linear;
  if (m.is_descriptor()) {
    problems.push_back({"/type", "\"luenberger\" takes systems of type \"lti\"",
                        "use the observer \"descriptor\""});
    return problems;
  }
  const bool grows = has_spread(m.A_radius) || has_spread(m.C_radius) ||
                     has_spread(m.sensor_radius());  // with the magnitudes of the states
  if (problems.empty() && grows) check_bounded_start(context, params, problems);
  check_observer_gain(context, params, "gain", steady_kalman(), problems);
  return problems;
}

}  // namespace

CORDON_COMPONENT(observer, luenberger) {
  ParamSchema schema = common_parameters();
  add_admissible_set(schema);
  add_widening_limit(schema);
  add_gain_parameter(schema, "gain",
                     "L, a matrix with a row per state and a column per output that makes A - L C "
                     "stable, or a designer of one; "
                     "absent: \"kalman\" with \"steady\"");
  registrar.add(ObserverEntry{
      {"luenberger", "set recursion with an output gain; standard linear systems, any backend",
       "Xu2014", std::move(schema)},
      check_luenberger,
      [](const ObserverContext& context, const Params& params) -> std::unique_ptr<Observer> {
        return std::make_unique<Luenberger>(context, params);
      },
      true,
      true});
}

}  // namespace cordon::estimators
