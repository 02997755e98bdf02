// SPDX-License-Identifier: GPL-3.0-or-later
#include "constrained_form.hpp"
#include "rounding_parameter.hpp"

namespace {

using namespace cordon;
using plugins::ConstrainedForm;

std::unique_ptr<SetBackend> create(const Params& params) {
  BackendInfo info;
  info.name = "constrained_zonotope";
  info.unbounded = false;
  info.intersections = true;
  info.rounding = plugins::rounding_from(params);
  info.summary = "zonotopes with linear constraints: convex polytopes, exact intersections";
  info.citation = "Scott2016";
  return std::make_unique<plugins::ValueBackend<ConstrainedForm>>(
      info, plugins::constrained_form_from(params, false));
}

void register_components(Registrar& registrar) {
  registrar.add(
      BackendEntry{{"constrained_zonotope",
                    "zonotopes with linear constraints: convex polytopes, exact intersections",
                    "Scott2016", plugins::constrained_schema()},
                   create});
}

}  // namespace

CORDON_PLUGIN("constrained_zonotope", "0.1.0", "GPL-3.0-or-later", "the Cordon authors",
              "constrained zonotopes", register_components)
