// SPDX-License-Identifier: GPL-3.0-or-later
// The Luenberger observer on sets, for x⁺ = A x + B f u + Bw w on any backend: X̂_0 = X0, then the recursion of
// luenberger_recursion.hpp, reduced to the budget. Its estimate at k uses the outputs up to k - 1 and is never empty; that an
// output contradicts it shows in the residual set, which the diagnoser "observer_bank" watches.
#include "components.hpp"
#include "observer_parameters.hpp"
#include "observers/luenberger_gain.hpp"
#include "observers/luenberger_recursion.hpp"

namespace cordon::estimators {

namespace {

class Luenberger final : public Observer {
 public:
  Luenberger(const ObserverContext& context, const Params& params)
      : Observer(context.model, context.backend),
        X0_(initial_set_from(model(), params)),
        recursion_(model(), params.has("gain") ? params.matrix("gain") : designed_gain(model()), context.backend,
                   budget_from(params)) {}

  LineForm initial_set() const override { return X0_; }

 private:
  Enclosure do_start(const std::optional<Enclosure>& X0, const Sample&) override {
    const Enclosure start = X0 ? *X0 : backend().import(X0_);
    return X_ = timed(Phase::reduce, [&] { return recursion_.reduced(start); });
  }
  Enclosure do_step(const Sample& before, const Sample&) override {
    const Enclosure next = timed(Phase::predict, [&] { return recursion_.next(X_, before); });
    return X_ = timed(Phase::reduce, [&] { return recursion_.reduced(next); });
  }
  void do_replace(const Enclosure& X) override { X_ = X; }

  LineForm X0_;
  LuenbergerRecursion recursion_;
  Enclosure X_;
};

std::vector<Diagnostic> check(const ObserverContext& context, const Params& params) {
  std::vector<Diagnostic> problems = check_common(context, params);
  const LinearModel& m = context.model.linear;
  if (m.is_descriptor()) {
    problems.push_back({"/type", "\"luenberger\" takes systems of type \"lti\"", "use the observer \"descriptor\""});
    return problems;
  }
  check_gain(context.model, params.has("gain") ? &params.matrix("gain") : nullptr, "/gain", "", problems);
  return problems;
}

}  // namespace

void register_luenberger(Registrar& registrar) {
  ParamSchema schema = common_parameters();
  schema.matrix(
      "gain",
      "L, a row per state and a column per output, with A - L C stable; absent: the steady gain of the zonotopic Kalman filter");
  registrar.observer({{"luenberger", "set recursion with a fixed output gain; standard linear systems, any backend", "Xu2014",
                       std::move(schema)},
                      check,
                      [](const ObserverContext& context, const Params& params) -> std::unique_ptr<Observer> {
                        return std::make_unique<Luenberger>(context, params);
                      },
                      true});
}

}  // namespace cordon::estimators
