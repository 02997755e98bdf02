// SPDX-License-Identifier: GPL-3.0-or-later
#include "constrained_form.hpp"
#include "rounding_parameter.hpp"

namespace {

using namespace cordon;
using plugins::ConstrainedForm;

std::unique_ptr<SetBackend> create(const Params& params) {
  BackendInfo info;
  info.name = "line_zonotope";
  info.unbounded = true;
  info.intersections = true;
  info.rounding = plugins::rounding_from(params);
  info.summary =
      "zonotopes with lines and linear constraints: polytopes and sets unbounded along subspaces, "
      "exact intersections";
  info.citation = "Rego2025";
  return std::make_unique<plugins::ValueBackend<ConstrainedForm>>(
      info, plugins::constrained_form_from(params, true));
}

void register_components(Registrar& registrar) {
  registrar.add(
      BackendEntry{{"line_zonotope",
                    "zonotopes with lines and linear constraints: polytopes and sets unbounded "
                    "along subspaces, exact intersections",
                    "Rego2025", plugins::constrained_schema()},
                   create});
}

}  // namespace

CORDON_PLUGIN("line_zonotope", "0.1.0", "GPL-3.0-or-later", "the Cordon authors", "line zonotopes",
              register_components)
