// SPDX-License-Identifier: GPL-3.0-or-later
// Upper and lower bounds of the state as trajectories of two coupled systems, each with a gain of
// its own if wanted.
#include "components.hpp"
#include "observers/interval_observer.hpp"

namespace cordon::estimators {

namespace {

std::vector<Diagnostic> check_interval_trajectory(const ObserverContext& context,
                                                  const Params& params) {
  std::vector<Diagnostic> problems;
  if (!check_interval_observer(context, params, problems)) return problems;
  const bool upper = params.has("upper_gain"), lower = params.has("lower_gain");
  if (params.has("gain") && (upper || lower)) {
    problems.push_back({"/gain", "stands beside gains of single bounds",
                        "give \"gain\", or \"upper_gain\" and \"lower_gain\""});
  } else if (upper != lower) {
    problems.push_back(
        {upper ? "/upper_gain" : "/lower_gain",
         std::string("is given without \"") + (upper ? "lower" : "upper") + "_gain\"",
         "give both, or \"gain\" for both bounds"});
  } else if (upper) {
    check_observer_gain(context, params, "upper_gain", steady_kalman(), problems);
    check_observer_gain(context, params, "lower_gain", steady_kalman(), problems);
    if (params.integer("inner_samples") > 0) {
      problems.push_back({"/inner_samples",
                          "an inner estimate is made for one gain: with two, a bound needs not "
                          "enclose the trajectories of its own",
                          "leave it out, or give \"gain\""});
    }
  } else {
    check_observer_gain(context, params, "gain", steady_kalman(), problems);
  }
  return problems;
}

std::unique_ptr<Observer> create(const ObserverContext& context, const Params& params) {
  if (!params.has("upper_gain"))
    return std::make_unique<IntervalObserver>(
        context, params, observer_gain(context, params, "gain", steady_kalman()).gain);
  return std::make_unique<IntervalObserver>(
      context, params, observer_gain(context, params, "upper_gain", steady_kalman()).gain,
      observer_gain(context, params, "lower_gain", steady_kalman()).gain);
}

constexpr const char* interval_trajectory_details =
    "With Ac = A - L C = Ac⁺ - Ac⁻ split by the signs of its entries, bounds lo ≤ x ≤ hi become\n"
    "    hi⁺ = Ac⁺ hi - Ac⁻ lo + B u + L y + ρ,   lo⁺ = Ac⁺ lo - Ac⁻ hi + B u + L y - ρ,\n"
    "    ρ = rad(A) max(|lo|, |hi|) + rad(B) |u| + |L| rad(C) max(|lo|, |hi|) + |Bw W| + |L Dv "
    "V|.\n"
    "With two gains each bound has its own L and Ac. Any stable gain gives an enclosure; its width "
    "stays\n"
    "bounded if the spectral radius of |Ac| + rad(A) + |L| rad(C) is below 1.\n"
    "The estimate at k uses outputs up to k - 1. Rounding errors are added to the bounds, on any "
    "backend.\n"
    "A gain that varies in time is taken at its steady state.";

}  // namespace

CORDON_COMPONENT(observer, interval_trajectory) {
  ParamSchema schema;
  add_gain_parameter(schema, "gain",
                     "gain of both bounds; absent, and the others too: the steady gain \"kalman\"");
  add_gain_parameter(schema, "upper_gain", "gain of the upper bound, together with lower_gain");
  add_gain_parameter(schema, "lower_gain", "gain of the lower bound");
  add_interval_parameters(schema);
  registrar.add(
      ObserverEntry{{"interval_trajectory",
                     "upper and lower trajectories around the state; standard linear systems "
                     "with interval matrices",
                     "Pourasghar2021", std::move(schema), interval_trajectory_details},
                    check_interval_trajectory,
                    create,
                    true,
                    true});
}

}  // namespace cordon::estimators
