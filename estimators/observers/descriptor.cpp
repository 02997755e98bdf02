// SPDX-License-Identifier: GPL-3.0-or-later
// Observer for descriptor systems E x⁺ = A x + B u + Bw w, y = C x + D u + Dv v with singular E.
// The recursion follows from what the backend can do: semi_explicit_observer.hpp where
// intersections are exact, else pseudo_inverse_observer.hpp.
#include "components.hpp"
#include "cordon/core/error.hpp"
#include "cordon/core/linalg.hpp"
#include "cordon/interfaces/descriptor_matrix.hpp"
#include "observer_parameters.hpp"
#include "observers/interval_spread.hpp"
#include "observers/pseudo_inverse_observer.hpp"
#include "observers/semi_explicit_observer.hpp"
#include "observers/static_rows.hpp"

namespace cordon::estimators {

namespace {

bool in_semi_explicit_form(const SetBackend& backend) { return backend.info().intersections; }

void check_semi_explicit(const ObserverContext& context, const Params& params,
                         std::vector<Diagnostic>& problems) {
  const LinearModel& m = context.model.linear;
  const BackendInfo& info = context.backend->info();
  try {
    StaticRows{m};
  } catch (const Error& error) {
    problems.push_back({"", error.what(), "write the equations in other units"});
  }
  if (!params.has("admissible_set") && !info.unbounded && m.is_descriptor() &&
      descriptor_rank(m.E) < m.states()) {
    problems.push_back(
        {"/admissible_set",
         "is missing: the backend \"" + info.name +
             "\" holds bounded sets only, so the part of the state that E does not determine "
             "needs a bound",
         "give a set that contains the state at all times, or use \"line_zonotope\""});
  }
}

void check_pseudo_inverse(const ObserverContext& context, const Params& params,
                          std::vector<Diagnostic>& problems) {
  const LinearModel& m = context.model.linear;
  const BackendInfo& info = context.backend->info();
  if (params.flag("static_at_start")) {
    problems.push_back(
        {"/static_at_start",
         "needs exact intersections, which the backend \"" + info.name + "\" does not have",
         "leave it out"});
  }
  if (has_spread(m.C_radius)) {
    problems.push_back(
        {"/type",
         "takes an interval matrix C with exact intersections only, which the backend \"" +
             info.name + "\" does not have",
         "use \"constrained_zonotope\" or \"line_zonotope\", or give an exact C"});
  }
  if (!has_pseudo_inverse(m)) {
    problems.push_back(
        {"",
         std::string("[E; C] does not have full column rank as far as doubles tell") +
             (m.sensor.dim() ? " without the outputs whose sensors can fail altogether" : "") +
             ", so that no T, N with T E + N C = I are found",
         "measure more, or use \"line_zonotope\""});
  }
}

std::vector<Diagnostic> check_descriptor(const ObserverContext& context, const Params& params) {
  std::vector<Diagnostic> problems = check_common(context, params);
  const LinearModel& m = context.model.linear;
  const Vector sigma =
      m.is_descriptor() ? linalg::svd(linalg::row_scales(m.E).asDiagonal() * m.E).sigma : Vector();
  for (Index i = 0; i < sigma.size(); ++i) {
    const double share = sigma[0] > 0 ? sigma[i] / sigma[0] : 0;
    if (share > 1e-13 && share < 1e-7) {
      problems.push_back(
          {"",
           "E is nearly singular (its singular values differ by a factor of " +
               std::to_string(1 / share) +
               "), so that it is not clear which of its rows are static",
           "set entries of E that stand for zero to zero, or choose other units of the states"});
      break;
    }
  }
  if (in_semi_explicit_form(*context.backend)) {
    check_semi_explicit(context, params, problems);
  } else {
    check_pseudo_inverse(context, params, problems);
  }
  return problems;
}

}  // namespace

CORDON_COMPONENT(observer, descriptor) {
  ParamSchema schema = common_parameters();
  schema.set("admissible_set",
             "set that holds the state at all times; needed by bounded representations with exact "
             "intersections, and by others where outputs are missing without which the state is "
             "not determined");
  schema.flag("static_at_start", "let the static rows of k = 0 cut the initial set", false);
  registrar.add(ObserverEntry{
      {"descriptor", "descriptor systems with singular E, any backend",
       "Rego2025; Rego2020b; Wang2018a", schema},
      check_descriptor,
      [](const ObserverContext& context, const Params& params) -> std::unique_ptr<Observer> {
        if (in_semi_explicit_form(*context.backend)) return semi_explicit_observer(context, params);
        return pseudo_inverse_observer(context, params);
      },
      true,
      true});
}

}  // namespace cordon::estimators
