// SPDX-License-Identifier: GPL-3.0-or-later
// The interval observer whose gain is monotone, A - L C ≥ 0: set-based and trajectory-based
// observer coincide. [Pourasghar2021, Theorem 5.3]
#include <cstdio>

#include "components.hpp"
#include "gains/gain_certificate.hpp"
#include "gains/monotone.hpp"
#include "observers/interval_observer.hpp"

namespace cordon::estimators {

namespace {

constexpr double tolerance = 1e-9;  // of the largest entry of A

ComponentSpec absent() { return {"h_infinity_monotone", {}}; }

/// "A - L C is negative at row 1, column 2: -0.1; at row …", or nothing.
std::string negative_entries(const Model& model, const Matrix& L) {
  const LinearModel& m = model.linear;
  const Matrix closed = IntervalRecursion(model, L).closed_loop();
  const double least = m.A.size() == 0 ? 0 : -tolerance * m.A.cwiseAbs().maxCoeff();
  std::string found;
  for (Index i = 0; i < closed.rows(); ++i) {
    for (Index j = 0; j < closed.cols(); ++j) {
      if (closed(i, j) >= least) continue;
      found += found.empty() ? "A - L C is negative at" : "; at";
      char value[32];
      std::snprintf(value, sizeof value, "%.6g", closed(i, j));
      found += " row " + std::to_string(i + 1) + ", column " + std::to_string(j + 1) + ": " + value;
    }
  }
  return found;
}

std::vector<Diagnostic> check_integrated(const ObserverContext& context, const Params& params) {
  std::vector<Diagnostic> problems;
  if (!check_interval_observer(context, params, problems)) return problems;
  const std::size_t before = problems.size();
  check_observer_gain(context, params, "gain", absent(), problems);
  if (problems.size() != before) return problems;
  const LinearModel& m = context.model.linear;
  const std::string negative =
      negative_entries(context.model, observer_gain(context, params, "gain", absent()).gain.L);
  if (negative.empty()) return problems;
  const std::optional<Obstacle> never = no_monotone_gain(m.A, shown_outputs(m));
  problems.push_back({params.has("gain") ? "/gain" : "", negative,
                      never ? never->reason + ": use the observer \"interval_trajectory\""
                            : "use the gain \"peak\" or \"h_infinity_monotone\", or the observer "
                              "\"interval_trajectory\""});
  return problems;
}

constexpr const char* integrated_details =
    "Centre and half widths of a box, with Ac = A - L C ≥ 0:\n"
    "    c⁺ = Ac c + B u + L y,   r⁺ = Ac r + rad(A) (|c| + r) + rad(B) |u| + |L| rad(C) (|c| + r) "
    "+ |Bw W| + |L Dv V|.\n"
    "The bounds equal those of \"interval_trajectory\" with the same gain, and the hull of "
    "\"zonotope_uncertain\" where\n"
    "the entries of every generator of X0, Bw W and L Dv V have one sign. A gain that leaves a "
    "negative entry in Ac is\n"
    "refused. Rounding errors are added to the bounds, on any backend. A gain that varies in time "
    "is taken at its\n"
    "steady state.";

}  // namespace

CORDON_COMPONENT(observer, integrated) {
  ParamSchema schema;
  add_gain_parameter(schema, "gain",
                     "gain with A - L C ≥ 0 in every entry; absent: \"h_infinity_monotone\"");
  add_interval_parameters(schema);
  registrar.add(ObserverEntry{
      {"integrated",
       "interval observer with a monotone gain; standard linear systems with interval matrices",
       "Pourasghar2021", std::move(schema), integrated_details},
      check_integrated,
      [](const ObserverContext& context, const Params& params) -> std::unique_ptr<Observer> {
        return std::make_unique<IntervalObserver>(
            context, params, observer_gain(context, params, "gain", absent()).gain);
      },
      true,
      true});
}

}  // namespace cordon::estimators
